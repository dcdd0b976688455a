# The surface of a volume as a mesh is closed, turned outwards, and where the kernel's field has the value. Derived: smoothing by the variance 1/3
# moves the field f by the sixth of its Laplacian, so that a ball of the distance d from its surface has the radius r with r + 1 / (3 r) = d. A ramp
# stays a ramp, so that the part of a box beyond one value has its exact volume, but for the faces of the box, which overlap by 0.03 voxels.
"$PYTHON" - <<'END'
import array, math
def write(name, size, value):
    x, y, z = size
    with open(f"{name}_{x}x{y}x{z}_float32.raw", "wb") as file:
        array.array("f", [value(i, j, k) for k in range(z) for j in range(y) for i in range(x)]).tofile(file)
write("ramp", (8, 6, 5), lambda i, j, k: i)
write("ball", (32, 32, 32), lambda i, j, k: 12 - math.dist((i, j, k), (15.5, 15.5, 15.5)))
END
halflight convert ramp_8x6x5_float32.raw --spacing 1,2,3 --iso 3.25 ramp.stl --quiet
for ending in stl ply obj; do halflight convert ball_32x32x32_float32.raw --iso 0 ball.$ending --quiet; done
halflight convert ball.ply again.obj --quiet
cmp ball.obj again.obj
halflight convert ball.obj again.stl --quiet
cmp ball.stl again.stl
for ending in stl ply obj; do halflight info ball.$ending --json >$ending.json; done
"$PYTHON" - <<'END'
import collections, json, math, struct
def read(name):
    data = open(name, "rb").read()
    count, = struct.unpack_from("<I", data, 80)
    assert len(data) == 84 + 50 * count and not data.startswith(b"solid")
    for n in range(count):
        numbers = struct.unpack_from("<12f", data, 84 + 50 * n)
        yield [numbers[3 * c:3 * c + 3] for c in range(4)]
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
def dot(a, b): return sum(x * y for x, y in zip(a, b))
def told(name, expected, tolerance):
    volume, edges, corners, outward = 0, collections.Counter(), set(), True
    for normal, a, b, c in read(name):
        volume += dot(a, cross(b, c)) / 6
        turned = cross([x - y for x, y in zip(b, a)], [x - y for x, y in zip(c, a)])
        outward &= dot(normal, turned) > 0 or math.hypot(*turned) < 1e-4
        edges.update([(a, b), (b, c), (c, a)])
        corners.update((a, b, c))
    print(name, "closed:", all(edges[b, a] == count for (a, b), count in edges.items()), "normals outwards:", outward,
          "volume:", abs(volume / expected - 1) < tolerance)
told("ramp.stl", (4.25 + 0.03 / 2) * (6 * 2) * (5 * 3), 4e-3)
radius = (12 + math.sqrt(12**2 - 4 / 3)) / 2
told("ball.stl", 4 / 3 * math.pi * radius**3, 2e-3)
files = [json.load(open(ending + ".json")) for ending in ("stl", "ply", "obj")]
print("one mesh in three files:", len({json.dumps([one[key] for key in ("triangles", "box")]) for one in files}))
normals = [tuple(map(float, line.split()[1:])) for line in open("ball.obj") if line.startswith("vn")]
places = [tuple(map(float, line.split()[1:])) for line in open("ball.obj") if line.startswith("v ")]
least = min(dot(n, [(x - 15.5) / math.dist(p, (15.5,) * 3) for x in p]) for n, p in zip(normals, places, strict=True))
print("smooth normals within 3 degrees:", least > math.cos(math.radians(3)))
END
for wrong in "ramp.stl" "--iso 99 ramp.stl" "--iso 1 ramp.nrrd" "--iso 1 --shrink 2 a.ply" "--iso 1 --exposure 1 a.ply" "--iso x a.ply" "--iso 1 a.gltf"; do
  halflight convert ramp_8x6x5_float32.raw $wrong 2>&1 && echo "not refused: $wrong" || true
done
halflight convert ball.ply --iso 1 a.obj 2>&1 || true
