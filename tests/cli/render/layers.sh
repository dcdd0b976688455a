# The picture is what it is without layers; they are files beside an .npy, channels of an .exr.
tool ball 12 ball_12x12x12_uint8.raw
halflight render ball_12x12x12_uint8.raw --size 32x32 --quiet -o plain.npy
halflight render ball_12x12x12_uint8.raw --size 32x32 --quiet --layers -o a.npy
halflight render ball_12x12x12_uint8.raw --size 32x32 --quiet --layers -o a.exr
cmp plain.npy a.npy
halflight diff a.npy a.exr --max-error 0 >text
for layer in ambient light0 light0_shadow light1 normal depth_first depth_mean; do
  test -s "a-$layer.npy"
  grep -q "$layer\\.[RGBXYZ]" a.exr
done
ls a*
tool sum_layers a.npy a-ambient.npy a-light0.npy a-light1.npy
halflight render ball_12x12x12_uint8.raw --size 8x8 --quiet --layers --reference --light-points 4 -o r.npy
tool sum_layers r.npy r-ambient.npy r-light0.npy r-light1.npy
