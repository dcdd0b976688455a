# An option equals the same setting in the scene, to the byte.
tool ball 12 ball_12x12x12_uint8.raw
scene() {
  cat <<END
{ "halflight": 1, "image": { "width": $1, "height": $2 },
  "camera": { "position": [-20, -30, 25], "target": [6, 6, 6], "up": [0, 0, 1], "fovy_deg": $3 },
  "lights": [ { "type": "directional", "direction": [1, 0.5, -1], "angular_diameter_deg": $4 } ],
  "volumes": [ { "file": "ball_12x12x12_uint8.raw", "shading": "$5",
    "transfer_function": { "opacity": [[60, 0], [200, 0.8]], "color": [[0, 1, 0.8, 0.6]] } } ],
  "render": { "shadows": "$6", "soft_method": "$7", "kernel": "$8", "sheet_spacing": $9 } }
END
}
scene 40 30 25 10 phong soft cascade bspline 0.5 >plain.json
scene 36 44 31 4 none soft paper linear 0.8 >wanted.json
halflight render wanted.json --quiet -o wanted.npy
tool coverage wanted.npy >box
halflight render plain.json --quiet -o got.npy --size 36x44 --fovy 31 --light-size 4 --shading none \
  --soft-method paper --kernel linear --sheet-spacing 0.8
cmp wanted.npy got.npy
scene 40 30 25 10 phong off cascade bspline 0.5 >off.json
halflight render off.json --quiet -o wanted.npy
halflight render plain.json --quiet -o got.npy --shadows off
cmp wanted.npy got.npy
