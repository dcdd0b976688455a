# Every listed preset and colormap is accepted.
tool ball 8 ball_8x8x8_uint8.raw
for name in $(halflight help presets); do
  halflight render ball_8x8x8_uint8.raw --size 8x8 --quiet -o x.npy --tf "$name"
done
for name in $(halflight help colormaps); do
  halflight render ball_8x8x8_uint8.raw --size 8x8 --quiet -o x.npy --colormap "$name"
done
halflight help colormaps | grep -qx viridis
