echo '{ "halflight": 1, "image": { "widht": 3 }, "volumes": [] }' >scene.json
halflight render scene.json
