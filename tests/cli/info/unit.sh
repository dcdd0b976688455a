# --unit states the unit of lengths of a file that does not tell it, and labels then have volumes in ml: 64 voxels with edges of 2.5 mm are 1000 mm³.
printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nspacings: 2.5 2.5 2.5\nencoding: raw\n\n' >map.nrrd
"$PYTHON" -c 'open("map.nrrd", "ab").write(bytes(x < 4 and y < 4 and z < 4 for z in range(8) for y in range(8) for x in range(8)))'
printf '1,corner\n' >names.csv
told() {
  halflight info "$@" --label-table names.csv | grep -E '^  (unit|labels)'
  halflight info "$@" --label-table names.csv --json >info.json
  tool json info.json "d['unit'], [(l['volume'], l.get('volume_ml')) for l in d['labels']]"
}
told map.nrrd
for unit in mm cm voxel; do told map.nrrd --unit $unit; done
# The file's own unit is known without the option. The option may repeat it, and another one is refused.
halflight convert map.nrrd micrometres.nrrd --unit um --quiet
told micrometres.nrrd --unit micron
told micrometres.nrrd
halflight info micrometres.nrrd --unit mm 2>&1 || echo $?
printf 'v 0 0 0\nv 3 0 0\nv 3 3 0\nf 1 2 3\n' >mesh.obj
halflight info mesh.obj --unit mm 2>&1 || echo $?
