# A maximum projection: greys on black from a bare volume; a scene's own colours; the reference agrees; the PNG's scene knows.
tool ball 16 ball_16x16x16_uint8.raw
halflight render ball_16x16x16_uint8.raw --size 64x64 --look mip --quiet -o a.npy --json >a.json
tool json a.json 'd["compositing"]'
halflight render ball_16x16x16_uint8.raw --size 64x64 --look mip --reference --quiet --depth 16 -o r.png
halflight render ball_16x16x16_uint8.raw --size 64x64 --look mip --quiet --depth 16 -o d.png
halflight diff d.png r.png --max-error 0.001 >text
halflight render ball_16x16x16_uint8.raw --size 64x64 --look mip --quiet -o a.png
tool png-pixel a.png 0 0
tool png-pixel a.png 32 32
tool png-scene a.png >inside.json
tool json inside.json 'd["render"]["compositing"]'
# The scene inside gives the same picture; light changes nothing.
halflight render inside.json --quiet -o b.npy
cmp a.npy b.npy
halflight render inside.json --quiet --shadows off -o c.npy
cmp a.npy c.npy
# A scene keeps its functions; a colour map takes their place.
sed 's/"compositing": "maximum"/"compositing": "light"/' inside.json >light.json
halflight render light.json --look mip --quiet -o d.npy
cmp a.npy d.npy
halflight render light.json --look mip --colormap hot --quiet -o e.png
tool png-pixel e.png 32 32
# And back, with the camera that framed what a maximum projection shows.
halflight render inside.json --look auto --quiet -o f.npy
halflight render ball_16x16x16_uint8.raw --size 64x64 --print-scene >plain.json
"$PYTHON" -c 'import json, sys
scene = json.load(open("plain.json"))
scene["camera"] = json.load(open("inside.json"))["camera"]
json.dump(scene, open("same.json", "w"))'
halflight render same.json --quiet -o g.npy
halflight diff f.npy g.npy --max-error 0 >text
