# Each motion runs, on several inputs and on the built-in volume.
# slow: it times many frames
tool ball 16 ball_16x16x16_uint8.raw
for move in light tf; do
  halflight bench ball_16x16x16_uint8.raw --frames 1 --size 16x16 --move $move | grep -q "moving $move; milliseconds"
done
halflight bench ball_16x16x16_uint8.raw ball_16x16x16_uint8.raw --frames 1 --size 16x16 --json >both.json
test "$(tool json both.json 'len(d), d[1]["input"]')" = "(2, 'ball_16x16x16_uint8.raw')"
halflight bench --frames 1 --size 32x32 | grep -q '^built-in: 32x32'
halflight bench --frames 1 --size 32x32 --threads 1 --only soft_cascade --json >only.json
test "$(tool json only.json 'd["threads"], d["frame_ms"]["soft_cascade"] > 0, d["frame_ms"]["hard"], d["frame_ms"]["off"]')" = "(1, True, None, None)"
