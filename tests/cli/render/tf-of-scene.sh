# --tf takes the function of a scene's first volume: the picture is the same.
tool ball 8 ball_8x8x8_uint8.raw
halflight render ball_8x8x8_uint8.raw --size 8x8 --threshold 100 --colormap viridis --quiet -o one.npy
halflight render ball_8x8x8_uint8.raw --size 8x8 --threshold 100 --colormap viridis --print-scene >ball.json
halflight render ball_8x8x8_uint8.raw --size 8x8 --tf ball.json --quiet -o two.npy
cmp one.npy two.npy
# A function that the scene leaves to the voxels is not to be had without them.
echo '{ "halflight": 1, "volumes": [ { "file": "ball_8x8x8_uint8.raw" } ] }' >bare.json
halflight render ball_8x8x8_uint8.raw --size 8x8 --tf bare.json -o three.npy 2>told || echo $?
cat told
test ! -e three.npy
