# A stop doubles the light, in the PNG alone; the background stays; the scene inside the PNG knows.
cat >slab.json <<END
{ "halflight": 1, "image": { "width": 16, "height": 16, "background": [0.5, 0.5, 0.5], "exposure": 1 },
  "camera": { "position": [0, -60, 30], "fovy_deg": 60 },
  "volumes": [ { "shapes": [ { "type": "box", "size": [40, 40, 12] } ], "shading": "flat",
    "transfer_function": { "color": [0.1, 0.25, 0.4] } } ] }
END
halflight render slab.json --quiet -o a.png
tool png-pixel a.png 8 8 | python3 -c '
asked, got = (124, 188, 231), [int(code) for code in input().split()]
print("within a code:", all(abs(a - b) <= 1 for a, b in zip(asked, got)))'
tool png-pixel a.png 0 0
tool png-scene a.png >inside.json
tool json inside.json 'd["image"]["exposure"]'
sed 's/, "exposure": 1//' slab.json >plain.json
halflight render plain.json --quiet --exposure 1 -o b.png
tool png-pixel b.png 8 8 >b.text
tool png-pixel a.png 8 8 | cmp - b.text
halflight render slab.json --quiet -o a.npy
halflight render plain.json --quiet -o b.npy
cmp a.npy b.npy
# Nor do they change by the tone, which takes the light of the PNG and keeps its hue.
sed 's/"exposure": 1/"exposure": 2, "tone": "filmic"/' slab.json >filmic.json
halflight render filmic.json --quiet -o c.npy
cmp a.npy c.npy
halflight render filmic.json --quiet -o c.png
halflight render plain.json --quiet --exposure 2 --tone filmic -o d.png
tool png-pixel d.png 8 8 >d.text
tool png-pixel c.png 8 8 | cmp - d.text
tool png-pixel c.png 8 8 | python3 -c '
asked, got = (130, 196, 242), [int(code) for code in input().split()]
print("bent:", all(abs(a - b) <= 1 for a, b in zip(asked, got)))'
