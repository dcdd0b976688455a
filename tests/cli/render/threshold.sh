# From the value on opaque, below it clear: a ball's middle is covered, its bare box is not; a higher value shows less.
tool ball 24 ball_24x24x24_uint8.raw
halflight render ball_24x24x24_uint8.raw --quiet --size 48x48 --threshold 128 -o a.npy
halflight render ball_24x24x24_uint8.raw --quiet --size 48x48 --threshold 128 --print-scene >scene.json
tool json scene.json "[[round(v, 6), a] for v, a in d['volumes'][0]['transfer_function']['opacity']]"
halflight render ball_24x24x24_uint8.raw --quiet --size 48x48 --threshold 300 -o b.npy
halflight render ball_24x24x24_uint8.raw --size 48x48 --threshold 300 -o b.npy 2>warning
sed -n 1p warning
# A low threshold leaves the least values clear: the ramp before it ends halfway to them.
halflight render ball_24x24x24_uint8.raw --quiet --size 48x48 --threshold 6 --print-scene >scene.json
tool json scene.json "[[round(v, 6), a] for v, a in d['volumes'][0]['transfer_function']['opacity']]"
