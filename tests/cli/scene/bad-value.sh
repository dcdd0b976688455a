tool ball 8 ball_8x8x8_uint8.raw
echo '{ "halflight": 1, "lights": [ { "type": "point", "position": [0, 0, 50], "radius": -1 } ],
  "volumes": [ { "file": "ball_8x8x8_uint8.raw" } ] }' >scene.json
halflight render scene.json
