# Only what is given changes: the elevation of the scene's own camera stays.
tool ball 12 ball_12x12x12_uint8.raw
scene() {
  cat <<END
{ "halflight": 1, "image": { "width": 32, "height": 32 },
  "camera": { "position": [6, $1, $2], "target": [6, 6, 6], "up": [0, 0, 1] },
  "volumes": [ { "file": "ball_12x12x12_uint8.raw" } ] }
END
}
scene -30 42 >steep.json # elevation 45 degrees
halflight render steep.json --quiet --azimuth 70 -o a.npy
tool coverage a.npy >box
halflight render steep.json --quiet --azimuth 70 --elevation 45 -o b.npy
halflight render steep.json --quiet --azimuth 70 --elevation 44 -o c.npy
halflight diff a.npy b.npy --max-rmse 1e-5 >text
if halflight diff a.npy c.npy --max-rmse 1e-5 >text 2>message; then exit 1; fi
