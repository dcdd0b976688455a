# Near the target, parallel and perspective projection show the same size; the way back is exact in size too.
tool ball 12 ball_12x12x12_uint8.raw
cat >scene.json <<END
{ "halflight": 1, "image": { "width": 64, "height": 64 },
  "camera": { "position": [6, -300, 6], "target": [6, 6, 6], "up": [0, 0, 1], "fovy_deg": 3 },
  "lights": [ { "type": "directional", "direction": [0, 1, 0] } ],
  "volumes": [ { "file": "ball_12x12x12_uint8.raw",
    "transfer_function": { "opacity": [[60, 0], [200, 0.8]], "color": [[0, 1, 0.8, 0.6]] } } ] }
END
halflight render scene.json --quiet -o perspective.npy
tool coverage perspective.npy >box
halflight render scene.json --quiet --ortho -o ortho.npy
halflight diff perspective.npy ortho.npy --max-rmse 0.05 >text
sed 's/"position": \[6, -300, 6\]/"type": "orthographic", "height": 16.025, "position": [6, -20, 6]/; s/, "fovy_deg": 3//' scene.json >flat.json
halflight render flat.json --quiet --fovy 3 -o back.npy
halflight diff perspective.npy back.npy --max-rmse 0.01 >text
