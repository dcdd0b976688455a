# A direction turns from key to key at an even speed and keeps its length, also where it turns round; a point goes straight. Both are one key, as X,Y,Z.
halflight make rings --size 24 --quiet
halflight render rings.nrrd --size 16x16 --sheet-spacing 4 --print-scene >scene.json
halflight animate scene.json --key lights.0.direction=0:-1,0,0,3:0,0,-1,6:0,0,1 --key camera.up=0:0,0,1 --key camera.position=2:1,-9,0,4:3,-9,4 --quiet -o out
for frame in 0 1 2 3 4 5 6; do
  tool png-scene out/000$frame.png >frame.json
  tool json frame.json '[[round(x, 9) + 0.0 for x in d["lights"][0]["direction"]], d["camera"]["position"]]'
done >frames.txt
sed -n '1,4p;7p' frames.txt
"$PYTHON" - frames.txt <<'END'
import json, math, sys
directions = [json.loads(line)[0] for line in open(sys.argv[1])]
angles = [math.degrees(math.acos(sum(a * b for a, b in zip(one, other)))) for one, other in zip(directions, directions[1:])]
print([round(math.hypot(*d), 6) for d in directions], [round(angle, 4) for angle in angles])
END
for key in 0:1,0 0:1,0,0,0 0:1,0,0, 0:1,0,nan 0:1,0,0,2:red 0:1,0,0,2:5 0:red 0:0,0,0; do
  halflight animate scene.json --key lights.0.direction=$key --quiet -o none 2>&1 || true
done
for path in lights.0.intensity camera.azimuth; do halflight animate scene.json --key $path=0:1,2,3 --quiet -o none 2>&1 || true; done
# Three numbers may be a colour, in linear light.
halflight animate scene.json --key lights.0.color=0:1,0.5,0,2:0,0.5,1 --quiet -o coloured
tool png-scene coloured/0001.png >frame.json
tool json frame.json 'd["lights"][0]["color"]'
