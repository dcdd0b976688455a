# Three scales are a grid of that spacing: placed, cut and lit alike, to the byte.
tool ball 12 ball_12x12x12_uint8.raw
printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 12 12\nencoding: raw\nspacings: 1 2 0.5\ndata file: ball_12x12x12_uint8.raw\n' >wide.nhdr
scene() {
  cat <<END
{ "halflight": 1, "image": { "width": 48, "height": 48 },
  "camera": { "position": [-20, -50, 25], "target": [6, 12, 3], "up": [0, 0, 1], "fovy_deg": 35 },
  "lights": [ { "type": "directional", "direction": [1, 0.5, -1], "angular_diameter_deg": 8 } ],
  "volumes": [ { "file": "$1", "transform": { "scale": $2, "rotate": { "axis": [0, 0, 1], "angle_deg": 20 } },
    "clip": { "min": [0, 0, 0], "max": $3 },
    "transfer_function": { "opacity": [[60, 0], [200, 0.8]], "color": [[0, 1, 0.8, 0.6]] } } ] }
END
}
scene wide.nhdr 1 '[7, 24, 3.5]' >wide.json
scene ball_12x12x12_uint8.raw '[1, 2, 0.5]' '[7, 12, 7]' >scaled.json
halflight render wide.json --quiet -o wide.npy
halflight render scaled.json --quiet -o scaled.npy
cmp wide.npy scaled.npy
tool coverage wide.npy >box
# The scene inside a picture has the three.
halflight render scaled.json --quiet -o scaled.png
tool png-scene scaled.png >inside.json
tool json inside.json 'd["volumes"][0]["transform"]["scale"]'
