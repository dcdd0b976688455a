# Percentiles are those of numpy, and the scene that is printed holds numbers; the logarithm puts the middle colour at the
# geometric mean.
"$PYTHON" -c "
import numpy
ramp = numpy.random.default_rng(1).permutation(numpy.arange(1, 4097)).astype(numpy.uint16)
ramp.reshape(16, 16, 16).tofile('ramp_16x16x16_uint16.raw')"
halflight render ramp_16x16x16_uint16.raw --print-scene --colormap grays --range 1%,99.5% >scene.json
tool json scene.json "[round(d['volumes'][0]['transfer_function']['color'][end][0], 3) for end in (0, -1)]"
cat >own.json <<'END'
{"halflight": 1, "volumes": [{"file": "ramp_16x16x16_uint16.raw", "transfer_function":
 {"opacity": [[0, 0], [4000, 0.5]], "colormap": "grays", "range": ["1%", "99.5%"], "scale": "log"}}]}
END
halflight render own.json --print-scene >scene.json
tool json scene.json "[round(d['volumes'][0]['transfer_function']['color'][n][0], 3) for n in (0, 32, -1)]"
halflight render ramp_16x16x16_uint16.raw --colormap grays --range 1%,99.5% --range-scale log --print-scene >scene.json
tool json scene.json "[round(d['volumes'][0]['transfer_function']['color'][n][0], 3) for n in (0, 32, -1)]"
# Without a colormap a preset or the automatic function spreads, as --range does.
cat >spread.json <<'END'
{"halflight": 1, "volumes": [{"file": "ramp_16x16x16_uint16.raw", "transfer_function": {"preset": "smoke", "range": [100, 2000], "scale": "log"}}]}
END
halflight render spread.json --print-scene >a.json
halflight render ramp_16x16x16_uint16.raw --tf smoke --range 100,2000 --range-scale log --print-scene >b.json
tool json a.json "d['volumes'][0]['transfer_function']" >a.txt
tool json b.json "d['volumes'][0]['transfer_function']" >b.txt
cmp a.txt b.txt
