# The picture is what it is without layers; they are files beside an .npy, channels of an .exr.
tool ball 12 ball_12x12x12_uint8.raw
halflight render ball_12x12x12_uint8.raw --size 32x32 --quiet -o plain.npy
halflight render ball_12x12x12_uint8.raw --size 32x32 --quiet --layers -o a.npy
halflight render ball_12x12x12_uint8.raw --size 32x32 --quiet --layers -o a.exr
cmp plain.npy a.npy
halflight diff a.npy a.exr --max-error 0 >text
for layer in ambient light0 light0_shadow light1 sky sky_shadow normal depth_first depth_mean object; do
  test -s "a-$layer.npy"
  grep -q "$layer\\.[RGBXYZ]" a.exr
done
ls a*
# Every channel of the .exr holds the numbers of the .npy of its layer: colours that differ show channels exchanged.
cat >b.json <<'END'
{"halflight": 1, "image": {"width": 32, "height": 32}, "ambient": [0.1, 0.15, 0.2],
 "lights": [{"type": "directional", "direction": [-1, -1, -0.5], "color": [1, 0.8, 0.5]},
            {"type": "directional", "direction": [1, 0.2, -0.5], "color": [0.3, 0.5, 0.9]}],
 "volumes": [{"file": "ball_12x12x12_uint8.raw", "attenuation_color": [0.4, 0.7, 1],
              "material": {"emission": 0.3},
              "transfer_function": {"opacity": [[40, 0], [200, 0.5]], "color": [[40, 0.9, 0.5, 0.2], [255, 0.3, 0.8, 0.6]]}}]}
END
halflight render b.json --quiet --layers -o b.npy
halflight render b.json --quiet --layers -o b.exr
tool exr-holds b.exr b.npy ambient=RGB emission=RGB light0=RGB light0_shadow=RGB light1=RGB light1_shadow=RGB \
  normal=XYZ depth_first=Z depth_mean=Z object=Z
tool sum_layers a.npy a-ambient.npy a-light0.npy a-light1.npy a-sky.npy
halflight render ball_12x12x12_uint8.raw --size 8x8 --quiet --layers --reference --light-points 4 -o r.npy
tool sum_layers r.npy r-ambient.npy r-light0.npy r-light1.npy r-sky.npy
