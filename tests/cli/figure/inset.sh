# An inset shows the middle of its panel, larger by its zoom: also of a scene whose floor reaches far beyond it.
cat >scene.json <<'END'
{ "halflight": 1, "image": { "width": 64, "height": 64, "background": [0.2, 0.3, 0.4] },
  "camera": { "type": "orthographic", "position": [0, -200, 60], "target": [0, 0, 10], "height": 60 },
  "volumes": [ { "shapes": [ { "type": "sphere", "radius": 12 } ], "voxel_size": 1 } ],
  "meshes": [ { "floor": 9 } ] }
END
sed 's/"height": 60/"height": 15/' scene.json >near.json
cat >figure.json <<'END'
{ "width": "16.256mm", "dpi": 100, "panels": [ { "input": "scene.json", "inset": { "zoom": 4, "part": 0.5 } } ] }
END
halflight figure figure.json --quiet -o figure.png
halflight render near.json --size 32x32 --quiet -o near.png
tool png-header figure.png
# The inset begins at pixel 31 of 64: half of the panel, and a rim of a fiftieth at the lower right.
for place in "4 6" "15 15" "28 20"; do
  set -- $place
  inset=$(tool png-pixel figure.png $((31 + $1)) $((31 + $2)))
  alone=$(tool png-pixel near.png $1 $2)
  test "$inset" = "$alone" || echo "$place: $inset, alone $alone"
done
# "at" is a place of the panel: 6 units to the right of its middle, and 3 below it.
sed -e 's/"position": \[0, -200, 60\], "target": \[0, 0, 10\]/"position": [6, -200.7276069, 57.0895726], "target": [6, -0.7276069, 7.0895726]/' near.json >aside.json
sed 's/"zoom": 4/"zoom": 4, "at": [0.6, 0.55]/' figure.json >at.json
halflight figure at.json --quiet -o at.png
halflight render aside.json --size 32x32 --quiet -o aside.png
for place in "4 6" "15 15" "3 28" "20 30"; do
  set -- $place
  inset=$(tool png-pixel at.png $((31 + $1)) $((31 + $2)))
  alone=$(tool png-pixel aside.png $1 $2)
  test "$inset" = "$alone" || echo "at: $place: $inset, alone $alone"
done
# An inset with a view of its own is framed anew.
cat >own.json <<'END'
{ "width": "16.256mm", "dpi": 100, "panels": [ { "input": "scene.json", "inset": { "view": "top", "zoom": 0.1 } } ] }
END
halflight figure own.json --quiet -o own.png
cmp -s figure.png own.png && echo same
sed 's/"zoom": 4/"zoom": 0/' figure.json >wrong.json
halflight figure wrong.json -o no.png 2>&1 || echo $?
sed 's/"zoom": 4/"at": [0.5, 7]/' figure.json >wrong.json
halflight figure wrong.json -o no.png 2>&1 || echo $?
