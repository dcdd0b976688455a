# A scene's cuts leave floors whole, that of --floor and that of a scene, unless they say otherwise.
tool ball 16 a_16x16x16_uint8.raw
cat >cut.json <<'END'
{"halflight": 1, "volumes": [{"file": "a_16x16x16_uint8.raw"}], "meshes": [{"spheres": [[8, 8, 8, 4]]}, {"floor": true}, {"floor": 2, "cut": true}],
 "cuts": [{"type": "plane", "point": [8, 8, 8], "normal": [1, 0, 0]}]}
END
halflight render cut.json --floor --print-scene >more.json
tool json more.json "[mesh['cut'] for mesh in d['meshes']]"
