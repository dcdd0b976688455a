# A file's shapes, as bare voxels and as NRRD: the same values; what --print gives is such a file.
cat >ball.json <<END
{ "groups": { "ball": [ { "type": "sphere", "radius": 5 } ] },
  "shapes": [ { "type": "group", "name": "ball" } ], "voxel_size": 1 }
END
halflight make ball.json --quiet
halflight make ball.json --quiet -o ball_19x19x19_float32.raw
halflight make ball.json --quiet -o ball_19x19x19_float32.raw.gz
gzip -dc ball_19x19x19_float32.raw.gz | cmp - ball_19x19x19_float32.raw
halflight info ball.nrrd --json >a.json
halflight info ball_19x19x19_float32.raw --json >b.json
tool json a.json 'd["dimensions"] + d["origin"] + [d["type"]] + d["range"]'
for key in histogram mean range type; do
  [ "$(tool json a.json "d['$key']")" = "$(tool json b.json "d['$key']")" ]
done
halflight make torus --print >ring.json
halflight make ring.json --quiet --size 32
halflight make torus --quiet --size 32
cmp ring.nrrd torus.nrrd
