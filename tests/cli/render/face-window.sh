# On the cut faces of a scanned body --range is a window of greys, from black to white, and neither the surface's colours
# nor any opacity changes. A lower window makes the face brighter. Where nothing is cut, or other options choose colours, the range spreads the
# function.
"$PYTHON" - <<'PY'
import array, math, random
noise = random.Random(1)
def value(x, y, z):
    distance = math.sqrt((x - 20) ** 2 + (y - 20) ** 2 + (z - 12) ** 2)
    return (40 if distance < 15 else -1000) + (900 if abs(distance - 12) < 1 else 0)
voxels = array.array("h", (max(-1024, round(value(x, y, z) + noise.gauss(0, 12)))
                           for z in range(40) for y in range(40) for x in range(40)))
voxels.tofile(open("head_40x40x40_int16.raw", "wb"))
PY
halflight info head_40x40x40_int16.raw | grep -o 'scanned body'
made() { name=$1; shift; halflight render head_40x40x40_int16.raw "$@" --print-scene --quiet >$name.json; }
made plain --cut-plane z=0.3
made window --cut-plane z=0.3 --range -160,240
made spread --range -160,240
made mapped --cut-plane z=0.3 --range -160,240 --colormap viridis
"$PYTHON" - <<'PY'
import json
function = {name: json.load(open(name + ".json"))["volumes"][0]["transfer_function"] for name in ("plain", "window", "spread", "mapped")}
def color(name, value):
    points = function[name]["color"]
    after = next((n for n, p in enumerate(points) if p[0] >= value), len(points) - 1)
    a, b = points[max(after - 1, 0)], points[after]
    t = 1 if b[0] == a[0] else min((value - a[0]) / (b[0] - a[0]), 1)
    return [p + t * (q - p) for p, q in zip(a[1:], b[1:])]
def code(light):
    return 12.92 * light if light < 0.0031308 else 1.055 * light ** (1 / 2.4) - 0.055
print([[round(code(c), 2) for c in color("window", v)] for v in (-140, 40, 240, 900)])
print(function["window"]["opacity"] == function["plain"]["opacity"], color("window", -500) == color("plain", -500))
print(function["spread"]["opacity"] == function["plain"]["opacity"], color("mapped", -160) == color("mapped", 240))
PY
for window in -160,240 -300,100; do
  halflight render head_40x40x40_int16.raw --cut-plane z=0.3 --range $window --view top --size 64 --quiet -o face.png
  tool png-pixel face.png 32 32
done
