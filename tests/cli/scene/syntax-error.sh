printf '{ "halflight": 1,\n  "volumes": [],\n  "image": }\n' >scene.json
halflight render scene.json
