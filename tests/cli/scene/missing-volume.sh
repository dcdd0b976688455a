echo '{ "halflight": 1, "volumes": [ { "file": "nowhere.nrrd" } ] }' >scene.json
halflight render scene.json
