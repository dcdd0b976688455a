# The scene on standard output renders to the same bytes, and no picture is made.
tool ball 16 ball_16x16x16_uint8.raw
set -- --size 40x30 --azimuth 100 --light 30,10 --colormap viridis --range 40,200 --clip x=0.1:0.7 --ambient steelblue
halflight render ball_16x16x16_uint8.raw "$@" --print-scene >scene.json
test "$(ls)" = "$(printf 'ball_16x16x16_uint8.raw\nscene.json')"
halflight render ball_16x16x16_uint8.raw --quiet "$@" -o a.npy
halflight render scene.json --quiet -o b.npy
cmp a.npy b.npy
# Printed again it is the same text.
halflight render scene.json --print-scene >again.json
cmp scene.json again.json
