# Matter of three times the density lets the third power of the light through: the homogeneous ball's middle.
"$PYTHON" -c 'import math
open("ball_24x24x24_uint8.raw", "wb").write(bytes(200 * (math.dist((x, y, z), (11.5,) * 3) < 9) for z in range(24) for y in range(24) for x in range(24)))'
printf '{ "opacity": [[0, 0], [200, 0.05]], "color": [1, 1, 1] }' >thin.json
through() {
  halflight render ball_24x24x24_uint8.raw --tf thin.json --smooth 0 --shading none --ortho --background transparent --size 64 --quiet "$@" -o ball.npy
  "$PYTHON" -c 'import array, math, struct
data = open("ball.npy", "rb").read()
values = array.array("f", data[10 + struct.unpack("<H", data[8:10])[0]:])
print(math.log(1 - values[4 * (32 * 64 + 32) + 3]))'
}
once=$(through)
for factor in 3 0.5; do
  "$PYTHON" -c "print(round($(through --density $factor) / ($once), 3))"
done
for wrong in 0 -1 x; do halflight render ball_24x24x24_uint8.raw --density $wrong 2>&1 || echo $?; done
