# --sky takes a colour, a gradient or an image's file; a black sky is none, and what cannot be read is refused.
halflight make torus --size 24 -o t.nrrd --quiet
sky() { halflight render t.nrrd --sky "$1" --print-scene | "$PYTHON" -c 'import json, sys; print(json.dumps(json.load(sys.stdin).get("sky")))'; }
sky 0.5
sky 0
sky 0.1,0.2,0.3:1
sky 0.1,0.2,0.3:white:0
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\200\200\200\201\100\100\100\201' >room.hdr
sky room.hdr
halflight render t.nrrd --sky room.hdr --size 32x32 -o image.npy --quiet
halflight render t.nrrd --sky room.hdr --print-scene >scene.json
halflight render scene.json --size 32x32 -o again.npy --quiet
halflight diff image.npy again.npy --max-rmse 0 >/dev/null
for wrong in room.jpg 1:2:3:4 1: absent.hdr; do
  if halflight render t.nrrd --sky "$wrong" -o x.png --quiet; then exit 1; fi
done
# without shadows a bare volume has constant light in place of its own sky, and keeps one that is asked for
light() { halflight render t.nrrd "$@" --print-scene | "$PYTHON" -c 'import json, sys; d = json.load(sys.stdin); print(d.get("sky", {}).get("type"), d["ambient"][0] > 0.1)'; }
light --shadows hard
light --shadows off
light --shadows off --sky 0.5
light --shadows off --ambient 0.3
