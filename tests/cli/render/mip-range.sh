# In a maximum projection --range LO,HI is black at LO and white at HI, whatever the preset's own greys were.
"$PYTHON" -c 'import array
side = 32
def value(x, y, z):
    r = ((x - 15.5) ** 2 + (y - 15.5) ** 2 + (z - 15.5) ** 2) ** 0.5
    return 3071 if (x, y, z) == (16, 16, 16) else 1200 if r < 7 else 40 if r < 12 else -1000
voxels = array.array("h", [value(x, y, z) for z in range(side) for y in range(side) for x in range(side)])
open("head_32x32x32_int16.raw", "wb").write(voxels.tobytes())'
ends='[[round(d["volumes"][0]["transfer_function"][key][end][0], 2) for end in (0, -1)] for key in ("opacity", "color")]'
halflight render head_32x32x32_int16.raw --look mip --range -1024,3000 --print-scene >stated.json
tool json stated.json "$ends"
# The range of a scene means the same.
"$PYTHON" -c 'import json
scene = json.load(open("stated.json"))
scene["volumes"][0]["transfer_function"] = {"preset": "mip", "range": [-100, 1500]}
json.dump(scene, open("scene.json", "w"))'
halflight render scene.json --print-scene >of-scene.json
tool json of-scene.json "$ends"
# Without a range, a little metal does not darken the bones of Hounsfield data.
halflight render head_32x32x32_int16.raw --look mip --print-scene >chosen.json
tool json chosen.json "$ends"
