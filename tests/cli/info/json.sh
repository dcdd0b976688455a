# Voxels 0, 10, 20, ... 110 in a 3 x 2 x 2 grid with its own spacing, origin and turned axes.
"$PYTHON" -c 'import sys; sys.stdout.buffer.write(bytes(range(0, 120, 10)))' >voxels.raw
cat >grid.nhdr <<END
NRRD0004
type: uchar
dimension: 3
space: right-anterior-superior
sizes: 3 2 2
space directions: (0,2,0) (-3,0,0) (0,0,4)
space origin: (5,6,7)
encoding: raw
data file: voxels.raw
END
halflight info grid.nhdr --json >info.json
tool json info.json 'd["dimensions"], d["type"], d["spacing"], d["origin"]'
tool json info.json 'd["direction"]'
tool json info.json 'd["world_box"]'
tool json info.json 'd["taken_for"] in ("field", "scanned matter")'
tool json info.json 'd["range"], d["mean"], d["nonfinite_count"]'
tool json info.json 'len(d["histogram"]), sum(d["histogram"]), d["histogram"][0], d["histogram"][255]'
