# One number is a square picture, wherever a command takes the size of one.
tool ball 8 ball_8x8x8_uint8.raw
for options in '--size 24' '--size=24' '--size 24x16'; do
  halflight render ball_8x8x8_uint8.raw $options --print-scene >scene.json
  tool json scene.json '(d["image"]["width"], d["image"]["height"])'
done
halflight bench ball_8x8x8_uint8.raw --size 24 --frames 1 --only off --json >bench.json
tool json bench.json '(d["width"], d["height"])'
