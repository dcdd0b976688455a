# Channels of a maximum projection that say no colour get one each: green, magenta; --colormap goes before it.
tool ball 16 ball_16x16x16_uint8.raw
cp ball_16x16x16_uint8.raw other_16x16x16_uint8.raw
for only in 0 1; do
  halflight render ball_16x16x16_uint8.raw other_16x16x16_uint8.raw --look mip --print-scene >both.json
  "$PYTHON" -c 'import json, sys
scene = json.load(open("both.json"))
scene["volumes"] = [scene["volumes"][int(sys.argv[1])]]
json.dump(scene, open("one.json", "w"))' "$only"
  halflight render one.json --size 64x64 --quiet -o one.png
  tool png-pixel one.png 32 32
done
halflight render ball_16x16x16_uint8.raw other_16x16x16_uint8.raw --look mip --colormap other_16x16x16_uint8=#0000ff --size 64x64 --quiet -o c.png
tool png-pixel c.png 32 32
# A volume alone stays grey.
halflight render ball_16x16x16_uint8.raw --look mip --size 64x64 --quiet -o grey.png
tool png-pixel grey.png 32 32
# Light adds up from black. Before another background a line says so, and before black none.
for background in white black transparent; do
  halflight render ball_16x16x16_uint8.raw other_16x16x16_uint8.raw --look mip --background $background --size 16x16 -o d.png 2>&1 | grep -c 'add up as light' || true
done
halflight render ball_16x16x16_uint8.raw --look mip --background white --size 16x16 -o d.png 2>&1 | grep -c 'add up as light' || true
