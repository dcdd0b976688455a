# In a maximum projection a colormap begins with the background's colour: values around the objects fade into it, so
# that no ring of the map's first colour surrounds them. Values of objects have the map's own colours.
"$PYTHON" -c "import math, random
random.seed(1)
def value(x, y, z):
    return 250 if math.dist((x, y, z), (15.5,) * 3) < 9 else 20 + round(random.triangular(-20, 20, 0))
open('ball_32x32x32_uint8.raw', 'wb').write(bytes(value(x, y, z) for z in range(32) for y in range(32) for x in range(32)))"
function='d["volumes"][0]["transfer_function"]["color"]'
show() { tool json "$1.json" "[[round(c, 2) for c in $function[n][1:]] for n in (0, -1)]"; }
mip() { halflight render ball_32x32x32_uint8.raw --look mip "$@"; }
for background in 1 0; do
  mip --background $background --colormap inferno --print-scene >$background.json
  show $background
done
# Without a background the picture is black, and the map fades into black.
mip --colormap viridis --print-scene >black.json
show black
# A transparent picture has no colour to fade into, and a function that was asked for keeps its colours.
mip --colormap inferno --background transparent --print-scene >clear.json
show clear
mip --colormap inferno --tf ct-bone --background 1 --print-scene 2>told >asked.json
show asked
# A range that ends before objects begin keeps its map.
mip --colormap inferno --range 20,30 --background 1 --print-scene >below.json
show below
# The values that fade end where the automatic function shows objects.
halflight render ball_32x32x32_uint8.raw --print-scene >auto.json
"$PYTHON" - <<'END'
import json
colors = [json.load(open(name))["volumes"][0]["transfer_function"]["color"] for name in ("1.json", "clear.json")]
begin = next(value for value, opacity in json.load(open("auto.json"))["volumes"][0]["transfer_function"]["opacity"] if opacity > 0)
faded = [a[0] for a, b in zip(*colors) if a != b]
print(len(faded) > 1, max(faded) < begin)
END
# On a logarithmic scale the decades fade evenly: the scale's middle keeps a part of its colour. A map that begins with the
# background's colour keeps its colours.
for background in transparent 0.5 0; do
  mip --background $background --range 1,250 --range-scale log --colormap inferno --print-scene >log.json
  tool json log.json "[round(c, 2) for c in $function[32][1:]]"
done
# A corner, which sees noise alone, is nearly white; the ball is the map's brightest colour.
mip --background 1 --colormap inferno --size 64x64 --quiet -o ball.png
tool png-pixel ball.png 32 32
