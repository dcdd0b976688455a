# Opacity and colours are spread over the values that are given.
tool ball 16 ball_16x16x16_uint8.raw
halflight render ball_16x16x16_uint8.raw --print-scene --colormap grays --range 100,200 >scene.json
tool json scene.json "[[d['volumes'][0]['transfer_function'][key][end][0] for end in (0, -1)] for key in ('color',)]"
tool json scene.json "[round(min(v for v, a in d['volumes'][0]['transfer_function']['opacity']), 3)]"
# A colormap without a range spreads over the values that are seen.
halflight render ball_16x16x16_uint8.raw --print-scene --threshold 100 --colormap grays >a.json
tool json a.json "[80 < d['volumes'][0]['transfer_function']['color'][0][0] < 140]"
