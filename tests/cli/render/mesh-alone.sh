# A mesh without a volume has the light of a bare volume: a soft key light, a fill light, a sky and a dark grey background. Where memory is
# short, constant light takes the place of the sky.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' >part.obj
lit() { halflight render part.obj --print-scene "$@" | "$PYTHON" -c 'import json, sys
scene = json.load(sys.stdin)
print([light["intensity"] for light in scene["lights"]], scene.get("sky", {}).get("strength"), scene["image"]["background"], scene["ambient"][0])'; }
lit
lit --max-memory 400M
# The whole part is seen: light comes from the sky where none comes from the lights.
halflight render part.obj --size 64 -o part.npy --quiet
"$PYTHON" -c 'import array, struct
data = open("part.npy", "rb").read()
values = array.array("f", data[10 + struct.unpack("<H", data[8:10])[0]:])
seen = [min(values[n:n + 3]) for n in range(0, len(values), 4) if values[n + 3] > 0.99]
print(len(seen) > 300, min(seen) > 0.05, max(seen) < 1.3)'
