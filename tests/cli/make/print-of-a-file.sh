halflight make --print ring.json
