# A maximum projection begins where noise around the objects ends: as far above the background as the least value lies
# below it. Without noise it begins at the background. The commonest value is known to some greys alone.
for noise in 20 0; do
  "$PYTHON" -c "import math, random
random.seed(1)
side, noise = 32, $noise
def value(x, y, z):
    return 250 if math.dist((x, y, z), (15.5,) * 3) < 9 else 100 + round(random.triangular(-noise, noise, 0))
open('ball_32x32x32_uint8.raw', 'wb').write(bytes(value(x, y, z) for z in range(side) for y in range(side) for x in range(side)))"
  halflight render ball_32x32x32_uint8.raw --look mip --print-scene >mip.json
  tool json mip.json "abs(d['volumes'][0]['transfer_function']['opacity'][0][0] - 100 - $noise) < 10"
done
