# The mesh of labels is closed and encloses the volume of the labels' voxels to 1 %. info lists the labels of a map with
# their voxels and volumes, and the volume of a mesh.
"$PYTHON" - <<'END'
import math
n, radius = 40, 12
def label(x, y, z):
    if math.dist((x, y, z), (19.5,) * 3) > radius: return 0
    return 1 if x < 20 else 5
with open("map.nrrd", "wb") as file:
    file.write(f"NRRD0004\ntype: uint8\ndimension: 3\nspace dimension: 3\nsizes: {n} {n} {n}\nspace directions: (2,0,0) (0,2,0) (0,0,2)\n"
               'space units: "mm" "mm" "mm"\nencoding: raw\n\n'.encode())
    file.write(bytes(label(x, y, z) for z in range(n) for y in range(n) for x in range(n)))
open("names.csv", "w").write("1,left\n5,right\n")
END
halflight info map.nrrd --label-table names.csv | grep -A1 labels | tail -2
for show in left,right all 5; do
  halflight convert map.nrrd part.stl --show $show --label-table names.csv --quiet
  halflight info part.stl --json >mesh.json
  halflight info map.nrrd --json >map.json
  "$PYTHON" -c "import json, sys
labels = json.load(open('map.json'))['labels']
voxels = sum(one['volume'] for one in labels if sys.argv[1] != '5' or one['value'] == 5)
print(abs(json.load(open('mesh.json'))['volume'] / voxels - 1) < 0.01)" $show
done
for wrong in "--show middle" "--show 5 --iso 1" ""; do
  halflight convert map.nrrd part.stl $wrong --label-table names.csv 2>&1 || echo $?
done
# An open mesh encloses no volume. The two triangles of a square have its area.
printf 'v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nf 1 2 3\nf 1 3 4\n' >square.obj
halflight info square.obj | grep -E 'area|volume'
# A mesh states no unit of length.
halflight convert map.nrrd part.stl --iso 0.5 --unit mm 2>&1 | tail -1
