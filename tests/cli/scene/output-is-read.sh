# Nothing that a scene reads is written over: a light's image, a volume's detached voxels, a transfer function, under any
# of their names; nor by a layer's file, or the default picture.
tool ball 16 ball_16x16x16_uint8.raw
halflight render ball_16x16x16_uint8.raw --size 16x16 --quiet -o slide.png
cp ball_16x16x16_uint8.raw voxels.npy
printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16 16 16\nencoding: raw\ndata file: voxels.npy\n' >ball.nhdr
echo '{ "opacity": [[100, 0], [200, 1]], "color": [[0, 1, 1, 1]] }' >look.exr
cp slide.png scene-ambient.npy
cat >scene.json <<'END'
{ "halflight": 1, "volumes": [ { "file": "ball.nhdr", "transfer_function": { "file": "look.exr" } } ],
  "lights": [ { "type": "point", "position": [0, 0, 99], "texture": { "file": "slide.png",
                "screen": { "center": [8, 8, 40], "right": [16, 0, 0], "up": [0, 16, 0] } } },
              { "type": "rect", "position": [0, 0, 99], "edge1": [9, 0, 0], "edge2": [0, 9, 0],
                "emission": { "file": "scene-ambient.npy" } } ] }
END
cp scene.json slide.json
ln slide.png hard.png
ln -s slide.png soft.png
mkdir folder
ln -s ../voxels.npy folder/other.npy
cksum slide.png voxels.npy look.exr scene-ambient.npy scene.json >before
code() { halflight render "$@" --quiet --size 16x16 && echo 0 || echo $?; }
for name in slide.png hard.png soft.png voxels.npy folder/other.npy ./look.exr; do code scene.json -o $name; done
code slide.json
code scene.json --layers -o scene.npy
code ball.nhdr --tf look.exr -o look.exr
cksum slide.png voxels.npy look.exr scene-ambient.npy scene.json | cmp - before
test ! -e scene.npy
code scene.json -o new.png
