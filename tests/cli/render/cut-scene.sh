# With several volumes the options cut the scene: fractions are of the box around all volumes, -0.5 to 15.5 and 17.5 to 33.5
# along x.
tool ball 16 a_16x16x16_uint8.raw
cp a_16x16x16_uint8.raw b_16x16x16_uint8.raw
cat >two.json <<'END'
{"halflight": 1, "volumes": [{"file": "a_16x16x16_uint8.raw"}, {"file": "b_16x16x16_uint8.raw",
  "transform": {"rotate": {"axis": [0, 0, 1], "angle_deg": 90}, "translate": [33, 0, 0]}}]}
END
halflight render two.json --cut-plane 0.5,0.5,0.5:1,0,0 --print-scene >cut.json
tool json cut.json "[round(c, 6) for c in d['cuts'][0]['point']]"
tool json cut.json "['cuts' in volume for volume in d['volumes']]"
halflight render cut.json --cut-sphere 0,0,0:2mm --print-scene >more.json
tool json more.json "[cut['type'] for cut in d['cuts']]"
