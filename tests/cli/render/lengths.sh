# Lengths with a unit are converted to the unit of the file, or of --unit where the file tells none; planes, boxes and
# clips outside of the volume are told with the volume's place.
tool ball 16 ball_16x16x16_uint8.raw
metres() { halflight render ball_16x16x16_uint8.raw --spacing 0.0625 --size 24 --quiet "$@"; }
metres --unit m --clip z=200mm:800mm --print-scene >scene.json
tool json scene.json "[d['volumes'][0]['clip'][end][2] for end in ('min', 'max')]"
metres --unit m --cut-plane z=200mm --cut-box y=20cm:80cm --cut-sphere 0.5m,50cm,500mm:100mm --print-scene >scene.json
tool json scene.json "[cut.get('point', [cut.get('min', [0, 0])[1]])[-1] or [cut['center'][1], cut['radius']] for cut in d['volumes'][0]['cuts']]"
metres --unit m --slice z=200mm -o millimetres.npy
metres --slice z=0.2u -o own.npy
cmp millimetres.npy own.npy
# The world of several volumes has a unit, too.
halflight render ball_16x16x16_uint8.raw ball_16x16x16_uint8.raw --spacing 0.0625 --unit m --slice z=200mm --quiet --print-scene >scene.json
tool json scene.json "d['cuts'][0]['point'][2]"
for wrong in "--slice z=200mm" "--slice z=200mm --unit cm" "--slice z=0" "--clip z=200mm:800mm" "--clip z=200mm:" "--clip z=:-2m --unit m"; do
  code=0
  metres $wrong -o no.png 2>message || code=$?
  echo $code "$(cat message)"
done
for idle in "plane z=200mm" "plane z=:200mm" "box z=200mm:800mm" "sphere 0,0,200mm:3u" "plane 9u,9u,9u:1,1,1"; do
  halflight render ball_16x16x16_uint8.raw --spacing 0.0625 --size 24 --cut-${idle% *} ${idle#* } -o no.png 2>message
  sed -n 1p message
done
# A face of the box is in the volume.
halflight render ball_16x16x16_uint8.raw --size 24 --cut-plane z=1 --cut-plane z=:0 --cut-box x=1: --clip y=0:1 -o no.png 2>message
grep -c warning message || true
halflight render ball_16x16x16_uint8.raw --spacing 0.0625 --size 24 --quiet --slice z=1 -o face.png
