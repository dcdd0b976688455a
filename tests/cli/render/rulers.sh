# A ruler between two points: a mark of the scene, which the picture draws as it draws the scene's own marks.
tool ball 16 ball_16x16x16_uint8.raw
ball() { halflight render ball_16x16x16_uint8.raw --size 64 --quiet "$@"; }
ball --ruler 0,0.5,0.5:1,0.5,0.5:width --ruler 1mm,2mm,3u:4mm,6mm,3u --print-scene >ruled.json
tool json ruled.json "d['marks']"
ball --unit um --ruler 1mm,2mm,3mm:4mm,6mm,3mm --print-scene >small.json
tool json small.json "d['marks'][0]['points']"
for wrong in 0,0,0 0,0,0:1,1 0,0,0:1,1,1: 0,0,0:1,1,x; do
  code=0
  ball --ruler $wrong -o no.png 2>message || code=$?
  echo $code "$(cut -c12-70 message)"
done
ball --marks -o no.png 2>message || grep -o 'measure by --ruler' message
code=0
ball --ruler 0,0,0:1,1,1 -o no.npy 2>message || code=$?
echo $code "$(cut -c12-70 message)"
ball --no-metadata --ruler 0,0.5,0.5:1,0.5,0.5:width -o direct.png || { echo "this build draws nothing"; exit 77; }
ball --ruler 0,0.5,0.5:1,0.5,0.5:width --print-scene >ruled.json
halflight render ruled.json --marks --no-metadata --quiet -o again.png
cmp direct.png again.png
ball --no-metadata -o plain.png
cmp -s direct.png plain.png || echo "the ruler is drawn"
