# `info` takes scenes, also in pictures: how much of each kind they hold, and each volume as of its file.
"$PYTHON" -c 'open("a_4x4x4_uint8.raw", "wb").write(bytes(range(64))); open("b_4x4x2_uint8.raw", "wb").write(bytes(32))'
halflight render a_4x4x4_uint8.raw b_4x4x2_uint8.raw --size 40x30 --print-scene >scene.json
halflight info scene.json | grep "scene  \|raw\|dimensions"
halflight info scene.json --json | "$PYTHON" -c 'import json, sys
told = json.load(sys.stdin)
print(told["width"], told["height"], told["meshes"], [(v["file"], v["dimensions"], v["range"]) for v in told["volumes"]])'
halflight render scene.json -o p.png --quiet
halflight info p.png | head -2
if halflight info scene.json --time 1 2>refused.txt; then exit 1; fi
cat refused.txt
