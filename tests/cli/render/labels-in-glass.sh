# Matter of a translucent look is so thin that the labels in it are seen: about .65 of their light passes the matter before them. --density goes on from
# there. Opaque looks, functions that are asked for, and labels that are seen anyway change nothing.
"$PYTHON" - <<'END'
import math
n = 32
def write(name, value):
    with open(f"{name}_{n}x{n}x{n}_uint8.raw", "wb") as file:
        file.write(bytes(value(math.dist((x, y, z), (15.5,) * 3), x, y, z) for z in range(n) for y in range(n) for x in range(n)))
def layer(away): return 0 if away > 15 else 90 if away > 12 else 230 if away > 9 else 150  # as skin, bone and brain
write("head", lambda away, x, y, z: max(0, layer(away) + (31 * x + 57 * y + 91 * z) % 17 - 8))
write("core", lambda away, x, y, z: int(away < 4))
write("lid", lambda away, x, y, z: int(away < 15.5 and y < 3))
END
cat >passing.py <<'END'
# How much light passes from the core's front to the eye, by the printed function.
import json, math
function = json.load(open("scene.json"))["volumes"][0]["transfer_function"]
points = function["opacity"]
def opacity(value):
    for (v, o), (w, p) in zip(points, points[1:]):
        if v <= value < w: return o + (p - o) * (value - v) / (w - v)
    return points[0][1] if value < points[0][0] else points[-1][1]
depth = -sum(sum(math.log1p(-min(opacity(mean + noise), 0.9999)) for noise in range(-8, 9)) / 17 * length
             for mean, length in ((90, 3), (230, 3), (150, 5))) / function.get("unit_distance", 1)
END
look() {
  labels=$1; shift
  halflight render head_32x32x32_uint8.raw --labels ${labels}_32x32x32_uint8.raw --show 1=red --view front --ortho --size 32 --print-scene "$@" 2>message >scene.json
  echo "$labels $*: $(cut -d, -f1 message)"
}
depth() { "$PYTHON" -c 'exec(open("passing.py").read()); print(depth)'; }
look core --look translucent
once=$(depth)
"$PYTHON" -c "import math; print('passes:', 0.55 < math.exp(-$once) < 0.75)"
look core --look translucent --density 3
"$PYTHON" -c "print('density 3:', round($(depth) / $once, 3))"
look lid --look translucent
"$PYTHON" -c "print('unchanged:', $(depth) / $once > 2)"
look core --look surface
look core --look translucent --threshold 100
halflight render head_32x32x32_uint8.raw --labels core_32x32x32_uint8.raw --show 1=red --look translucent --size 64 --quiet -o red.png
tool png-pixel red.png 32 32 | "$PYTHON" -c 'red, green, blue = map(int, input().split()); print("red:", red > 1.3 * green)'
