# Flat colours match a legend: sRGB of (0.2, 0.5, 0.8) is 124 188 231, whatever the lights.
cat >slab.json <<END
{ "halflight": 1, "image": { "width": 16, "height": 16 },
  "camera": { "position": [0, -60, 30], "fovy_deg": 10 },
  "volumes": [ { "shapes": [ { "type": "box", "size": [40, 40, 12] } ], "shading": "flat",
    "transfer_function": { "color": [0.2, 0.5, 0.8] } } ] }
END
halflight render slab.json --quiet --depth 8 -o a.png
tool png-pixel a.png 8 8 | python3 -c '
asked, got = (124, 188, 231), [int(code) for code in input().split()]
print("within a code:", all(abs(a - b) <= 1 for a, b in zip(asked, got)))'
# The option does the same, and a flat volume has a layer of its own.
sed 's/"flat"/"none"/' slab.json >lit.json
halflight render slab.json --quiet -o flat.npy
halflight render lit.json --quiet --shading flat --layers -o option.npy
cmp flat.npy option.npy
tool sum_layers option.npy option-emission.npy option-ambient.npy option-light0.npy
