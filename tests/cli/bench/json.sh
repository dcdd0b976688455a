# Medians of every kind of shadow, by stage; the stages add up to frames.
tool ball 24 ball_24x24x24_uint8.raw
halflight bench ball_24x24x24_uint8.raw --frames 3 --size 32x24 --threads 1 --json >bench.json
test "$(tool json bench.json 'd["width"], d["height"], d["frames"], d["move"]')" = "(32, 24, 3, 'camera')"
test "$(tool json bench.json 'sorted(d["frame_ms"])')" = "['hard', 'off', 'soft_cascade', 'soft_paper', 'soft_sublights']"
test "$(tool json bench.json 'd["frame_ms"]["off"] > 0 and d["frame_ms"]["soft_cascade"] > 0')" = True
test "$(tool json bench.json 'len(d["stage_ms"]["hard"])')" = 9
test "$(tool json bench.json 'd["stage_ms"]["off"]["splat_light"]')" = 0
test "$(tool json bench.json 'd["work"]["off"]["samples_shaded"] > 500')" = True
test "$(tool json bench.json 'd["work"]["off"]["pixels"]["light"]["filled"]')" = 0
test "$(tool json bench.json 'd["work"]["hard"]["pixels"]["light"]["filled"] > 0')" = True
