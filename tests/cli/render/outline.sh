# An outline is the edges of the volume's box: twelve lines of two points and eight spheres, whole where the volume is cut,
# within the picture, and the same bytes from its scene.
tool ball 16 ball_16x16x16_uint8.raw
halflight render ball_16x16x16_uint8.raw --spacing 2,1,1 --outline --clip x=0:0.5 --ortho --view front --size 64 --print-scene >scene.json
tool json scene.json "len(d['meshes']), d['meshes'][0]['name']"
tool json scene.json "[len(line) for line in d['meshes'][0]['lines']] == [2] * 12"
tool json scene.json "sorted({tuple(s[:3]) for s in d['meshes'][0]['spheres']})"
halflight render ball_16x16x16_uint8.raw --spacing 2,1,1 --outline --clip x=0:0.5 --ortho --view front --size 64 --quiet -o direct.npy
halflight render scene.json --quiet -o again.npy
cmp direct.npy again.npy
# The whole box is seen: from the front it is twice as wide as high, and it ends before the picture does.
"$PYTHON" - <<'END'
import ast, struct
data = open("direct.npy", "rb").read()
length, = struct.unpack("<H", data[8:10])
height, width, channels = ast.literal_eval(data[10:10 + length].decode())["shape"]
numbers = struct.unpack(f"<{height * width * channels}f", data[10 + length:])
seen = [(x, y) for y in range(height) for x in range(width) if numbers[channels * (y * width + x) + channels - 1] > 0.2]
columns, rows = [x for x, _ in seen], [y for _, y in seen]
print(0 < min(columns), max(columns) < width - 1, abs((max(columns) - min(columns)) - 2 * (max(rows) - min(rows))) <= 3)
END
halflight render ball_16x16x16_uint8.raw --outline --floor --size 16 --print-scene >floor.json
tool json floor.json "[m['name'] for m in d['meshes']]"
for wrong in "ball_16x16x16_uint8.raw --look mip" "ball_16x16x16_uint8.raw --slice z=0.5" "wall.obj"; do
  printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >wall.obj
  code=0
  halflight render $wrong --outline --quiet -o no.png 2>message || code=$?
  echo $code "$(cut -c12-110 message)"
done
# The wires do not choose the view: a long field is seen from where it is seen without them.
"$PYTHON" - <<'END'
import math
def value(i, j, k):
    x, y, z = i - 11.5, j - 11.5, k - 11.5
    return int(250 * math.exp(-((x / 2 - 0.866 * y) / 8) ** 2 - ((0.866 * x + y / 2) / 2.5) ** 2 - (z / 2.5) ** 2))
with open("long.nrrd", "wb") as file:
    file.write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 24 24 24\nencoding: raw\n\n")
    file.write(bytes(value(i, j, k) for k in range(24) for j in range(24) for i in range(24)))
END
halflight render long.nrrd --print-scene >bare.json 2>/dev/null
halflight render long.nrrd --outline --print-scene >wired.json 2>/dev/null
"$PYTHON" - <<'END'
import json
way = []
for name in ("bare.json", "wired.json"):
    camera = json.load(open(name))["camera"]
    away = [a - b for a, b in zip(camera["position"], camera["target"])]
    way.append([a / sum(b * b for b in away) ** 0.5 for a in away])
print(max(abs(a - b) for a, b in zip(*way)) < 1e-9)
END
