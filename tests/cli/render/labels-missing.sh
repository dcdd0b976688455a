# A label that a map lacks: the labels that there are; a name that is spelled like one.
"$PYTHON" -c 'import sys
voxels = bytes(0 if n < 300 else 3 if n % 16 < 8 else 7 for n in range(4096))
open("map.nrrd", "wb").write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16 16 16\nencoding: raw\n\n" + voxels)
open("table.csv", "w").write("3,liver,255,0,0\n7,kidney,0,255,0\n")'
halflight render map.nrrd --labels map.nrrd --show nothing -o o.png && exit 9
halflight render map.nrrd --labels map.nrrd --label-table table.csv --show nothing,3 -o o.png && exit 9
halflight render map.nrrd --labels map.nrrd --label-table table.csv --show livre -o o.png && exit 9
test ! -e o.png
