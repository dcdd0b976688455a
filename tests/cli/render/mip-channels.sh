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
# Before white, channels darken each other: green where one is, black where both are, white where none is. The greater
# the value, the farther from white; the reference and the scene give the same.
mip() { halflight render ball_16x16x16_uint8.raw other_16x16x16_uint8.raw --look mip --ortho --view front --size 64 --quiet "$@"; }
mip --background white -o white.png
tool png-pixel white.png 32 32
tool png-pixel white.png 1 1
mip --background white --clip other_16x16x16_uint8=x=0:0.5 -o half.png
tool png-pixel half.png 36 32
mip --background white -o white.npy
mip --background white --reference -o exact.npy
"$PYTHON" -c "import numpy as np
exact, white = np.load('exact.npy'), np.load('white.npy')
apart = np.abs(exact - white)[(exact[..., 3] == 1) & (white[..., 3] == 1)]
print(apart.size > 4000, apart.max() < 0.02)"
mip --background white --print-scene >white.json
halflight render white.json --quiet -o again.npy
cmp white.npy again.npy
mip -o black.npy
"$PYTHON" -c "import numpy as np
black, white = np.load('black.npy')[32, :, :3], np.load('white.npy')[32, :, :3]
encode = lambda x: np.where(x < 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9)**(1 / 2.4) - 0.055)
print(np.abs(encode(white) - (1 - encode(black)))[12:52].max() < 0.02)"
# A line says so before a bright background, and before black none. Colormaps do not begin with the background.
for background in white black transparent; do
  halflight render ball_16x16x16_uint8.raw other_16x16x16_uint8.raw --look mip --background $background --size 16x16 -o d.png 2>&1 | grep -c 'darken each other' || true
done
halflight render ball_16x16x16_uint8.raw other_16x16x16_uint8.raw --look mip --background white --colormap viridis,inferno --size 16 -o d.png 2>&1 | grep -c 'add up as light' || true
halflight render ball_16x16x16_uint8.raw --look mip --background white --size 16x16 -o d.png 2>&1 | grep -c 'each other' || true
