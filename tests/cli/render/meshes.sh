# Meshes among the operands: added to the volumes, framed with them, kept in the scene; alone they are a scene.
# slow: frames of several hundred sheets
tool ball 16 a_16x16x16_uint8.raw
printf 'v 0 0 0\nv 40 0 0\nv 40 40 0\nv 0 40 0\nf 1 2 3 4\n' >board.obj
halflight render a_16x16x16_uint8.raw board.obj --print-scene >both.json
tool json both.json "[m['file'] for m in d['meshes']], len(d['volumes'])"
halflight render a_16x16x16_uint8.raw board.obj --quiet --size 32x32 -o both.npy
halflight render both.json --quiet --size 32x32 -o again.npy
cmp both.npy again.npy
halflight render board.obj --quiet --size 32x32 -o board.npy
halflight render board.obj --print-scene >board.json
tool json board.json "'volumes' in d, len(d['meshes'])"
for inputs in "board.obj both.json" "absent.ply"; do
  code=0
  halflight render $inputs --quiet -o more.png 2>message || code=$?
  echo $code $(cat message)
done
code=0
halflight render board.json --look mip --quiet -o more.png 2>message || code=$?
echo $code $(cat message)
halflight render board.obj --floor --print-scene >floor.json
tool json floor.json "[m.get('name') for m in d['meshes']], len(d['meshes'][1]['vertices'])"
