# A light in camera axes lights every view alike: a headlight and a lamp at the upper left, and the writer and the reference keep them.
tool ball 16 ball_16x16x16_uint8.raw
for light in '{ "type": "directional", "direction": [1, -1, -1], "frame": "camera" }' \
  '{ "type": "disk", "position": [-30, 30, 30], "normal": [0, 0, -1], "radius": 4, "frame": "camera" }'; do
  cat >lit.json <<END
{ "halflight": 1, "image": { "width": 32, "height": 32 }, "lights": [ $light ], "volumes": [ { "file": "ball_16x16x16_uint8.raw" } ] }
END
  for azimuth in 0 100 200; do
    halflight render lit.json --shadows off --quiet --azimuth $azimuth -o a.npy
    tool brightness a.npy | awk '!($1 > 1.05 * $2 && $3 > 1.05 * $4) { exit 1 }'
  done
done
halflight render lit.json --print-scene >again.json
tool json again.json 'd["lights"][0]["frame"], d["lights"][0]["position"]'
halflight render again.json --quiet -o b.npy
halflight render lit.json --quiet -o a.npy
cmp a.npy b.npy
halflight render lit.json --reference --light-points 64 --size 16x16 --quiet -o r.npy
tool brightness r.npy | awk '!($1 > 1.05 * $2 && $3 > 1.05 * $4) { exit 1 }'
