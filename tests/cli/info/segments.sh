# A segmentation's file names its segments: `info` lists them, `render` shows each in its own colour.
"$PYTHON" -c 'voxels = bytes(v for z in range(6) for y in range(6) for x in range(6) for v in (x < 3, 4 * (y > 2)))
open("s.seg.nrrd", "wb").write(b"""NRRD0004
type: uchar
dimension: 4
sizes: 2 6 6 6
kinds: list domain domain domain
encoding: raw
Segment0_Name:=left lung
Segment0_Color:=1 0.5 0
Segment0_LabelValue:=1
Segment0_Layer:=0
Segment1_Name:=heart
Segment1_LabelValue:=4
Segment1_Layer:=1

""" + voxels)'
halflight info s.seg.nrrd | grep -A1 segments
halflight info s.seg.nrrd --json | "$PYTHON" -c 'import json, sys
print(json.load(sys.stdin)["segments"])'
halflight render s.seg.nrrd --print-scene | "$PYTHON" -c 'import json, sys
for volume in json.load(sys.stdin)["volumes"]:
    print(volume.get("component"), [(label["name"], label["value"]) for label in volume["labels"]])'
halflight render s.seg.nrrd --component 1 --print-scene | grep -c '"labels"' || true
