touch scene.json
halflight scene.json
