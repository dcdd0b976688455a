# Each volume has its own function; names are those of the scene, or of the files.
tool ball 16 ball_16x16x16_uint8.raw
cat >two.json <<'END'
{"halflight": 1, "volumes": [{"file": "ball_16x16x16_uint8.raw"},
  {"name": "other", "file": "ball_16x16x16_uint8.raw", "transform": {"translate": [20, 0, 0]}}]}
END
echo '{"opacity": [[0, 0], [9, 0.5]], "color": [1, 0, 0]}' >red.json
echo '{"opacity": [[0, 0], [8, 0.5]], "color": [0, 1, 0]}' >green.json
halflight render two.json --print-scene --tf ball_16x16x16_uint8=red.json --tf other=green.json >scene.json
tool json scene.json "[v['transfer_function']['opacity'][1] for v in d['volumes']]"
halflight render two.json --print-scene --tf other=green.json >scene.json
tool json scene.json "d['volumes'][1]['transfer_function']['opacity'][1], len(d['volumes'][0]['transfer_function']['opacity']) > 2"
for tf in nobody=red.json 'other=red.json --tf red.json'; do
  code=0
  halflight render two.json --print-scene --tf $tf 2>message || code=$?
  echo $code $(cat message)
done
