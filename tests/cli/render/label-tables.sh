# Tables of labels: a label that ITK-SNAP's table hides stays hidden under "all" and shows by name; a name may have ":"
# in it, also before a number; marks of UTF-8 and ends of lines of old Macs are no part of a name.
"$PYTHON" -c 'import struct
header = b"{\x27descr\x27: \x27|u1\x27, \x27fortran_order\x27: False, \x27shape\x27: (8, 8, 8), }"
header += b" " * (117 - len(header)) + b"\n"
voxels = bytes(13 if x < 3 else 42 if x > 4 else 0 for z in range(8) for y in range(8) for x in range(8))
open("labels.npy", "wb").write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + voxels)
snap = "# ITK-SnAP{0}   13  255 0 0  1  0  0  \"part: left{0}\"{0}   42  0 0 255  1  1  1  \"part:2\"{0}"
open("snap.txt", "w").write(snap.replace("left{0}", "left").format("\n"))
open("mac.txt", "w", newline="").write(snap.replace("left{0}", "left").format("\r"))
open("mark.csv", "w", encoding="utf-8-sig").write("13,a,0,255,0\n42,b,0,0,255\n")
open("dseg.tsv", "w").write("index\tname\tcolor\n13\tLeft Cortex\t#00ff00\n42\tb\t#0000ff\n")'
shown() { halflight render labels.npy --label-table "$@" --print-scene | "$PYTHON" -c 'import json, sys
for label in json.load(sys.stdin)["volumes"][0]["labels"]:
    color = [round(255 * c) for c in label["color"]]
    print(label["name"], color, label.get("visible", True), label["opacity"])'; }
for table in snap.txt mac.txt; do shown $table; shown $table --show all; done
shown snap.txt --show 'part: left,part:2:0.5'
shown snap.txt --show 'part:2'
shown mark.csv
shown dseg.tsv --show 'Left Cortex=red:0.25'
# Columns may be named in a first line, in any order, with colours as "#rrggbb" or as three columns or by their names in CSS; a colour after a name needs none.
printf '%s\n' 'Name;Label;Red;Green;Blue' 'Left Cortex;13;0;255;0' 'b;42;0;0;255' >columns.csv
printf '%s\n' '"name","id","color"' '"Cortex, left",13,#00ff00' 'b,42,n/a' >quoted.csv
printf '%s\n' 'label,name,color' '13,Left Cortex,#00ff00' '42,b,#0000ff' >hex.csv
printf '%s\n' '13,Left Cortex,#00ff00' '42,b,#0000ff' >bare.csv
printf '%s\n' 'label,name,color' '13,Left Cortex,lime' '42,b,blue' >words.csv
for table in columns.csv quoted.csv hex.csv bare.csv words.csv; do shown $table | sed -n 1p; done
printf '%s\n' 'label,name,color' '13,Left Cortex,greenish' >wrong.csv
if halflight render labels.npy --label-table wrong.csv -o p.png 2> refused.txt; then exit 1; fi
grep -o 'wrong.csv: line 2: is no label' refused.txt
# Names are found in upper or lower case, unless a label has the very name.
printf '13,Left,0,255,0\n42,LEFT,0,0,255\n' >case.csv
for name in LEFT left Left; do echo "$name:"; shown case.csv --show "$name"; done
if halflight render labels.npy --label-table snap.txt --show 'part: right:2' -o p.png 2> refused.txt; then exit 1; fi
grep -o 'give an opacity from 0 to 1 after the colon' refused.txt
