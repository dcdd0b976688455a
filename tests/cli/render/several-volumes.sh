# Two volumes in one world, each with the look that it has alone, or its own; names are those of the files.
# slow: it guesses many looks
tool ball 16 a_16x16x16_uint8.raw
mkdir b
{ printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16 16 16\naxis mins: 30 0 0\nencoding: raw\n\n'; cat a_16x16x16_uint8.raw; } >b/c.nrrd
cp b/c.nrrd c.nrrd
halflight render a_16x16x16_uint8.raw b/c.nrrd c.nrrd --print-scene >scene.json
tool json scene.json "[v['name'] for v in d['volumes']]"
halflight render b/c.nrrd --print-scene >alone.json
tool json alone.json "d['volumes'][0]['transfer_function']" >one
tool json scene.json "d['volumes'][1]['transfer_function']" >other
cmp one other
halflight render a_16x16x16_uint8.raw b/c.nrrd --quiet --print-scene --tf c=ct-bone --colormap a_16x16x16_uint8=viridis --colormap c=magma >own.json
tool json own.json "[len(v['transfer_function']['color']) > 9 for v in d['volumes']], d['volumes'][0]['transfer_function']['opacity'] != d['volumes'][1]['transfer_function']['opacity']"
# Both are in the picture: it is wider than one alone.
halflight render a_16x16x16_uint8.raw b/c.nrrd --quiet --size 64x32 --azimuth 0 -o both.npy
halflight render own.json --quiet -o again.npy
halflight render a_16x16x16_uint8.raw b/c.nrrd --quiet --tf c=ct-bone --colormap a_16x16x16_uint8=viridis --colormap c=magma -o own.npy
cmp own.npy again.npy
test -f a_16x16x16_uint8.png || halflight render a_16x16x16_uint8.raw c.nrrd --quiet --size 8x8
test -f a_16x16x16_uint8.png
for inputs in "scene.json c.nrrd" "c.nrrd scene.json" "c.nrrd absent.nrrd"; do
  code=0
  halflight render $inputs 2>message || code=$?
  echo $code $(cat message)
done
# Sheets are as close as the closest of both alone, in the world. Volumes of very different scale make many sheets, and a line says so.
ball() { # size, edge of a voxel
  tool ball $1 ball.raw
  printf "NRRD0004\ntype: uint8\ndimension: 3\nsizes: $1 $1 $1\nspacings: $2 $2 $2\nencoding: raw\n\n"
  cat ball.raw
}
ball 64 0.5 >fine.nrrd
ball 16 2 >coarse.nrrd
ball 16 0.01 >tiny.nrrd
for inputs in fine.nrrd coarse.nrrd "fine.nrrd coarse.nrrd" "coarse.nrrd tiny.nrrd"; do
  halflight render $inputs --print-scene 2>message >sheets.json
  tool json sheets.json "d['render']['sheet_spacing']"
  grep -c ' sheets, since the smallest voxel edges' message || true
done
