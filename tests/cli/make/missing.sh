halflight make shapes.json
