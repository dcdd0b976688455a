# --views: files are the pictures that --view makes, a sheet has the same pixels side by side.
halflight make rings --size 24 --quiet
halflight render rings.nrrd --views front,left,top --size 50x40 --quiet -o 'side-%s.png'
for side in front left top; do
  halflight render rings.nrrd --view $side --size 50x40 --quiet -o alone.png
  cmp alone.png side-$side.png
done
halflight render rings.nrrd --views front,left,top --size 50x40 -o sheet.png 2>&1 | sed 's/, [0-9.e-]* s$//'
# --width is the width of the whole sheet: 60 mm at 100 dots an inch are 236 pixels, to the rounding of three sides.
halflight render rings.nrrd --views front,left,top --width 60mm --dpi 100 --quiet -o wide.png
tool png-header wide.png
halflight render rings.nrrd --views front,lft -o no.png 2>&1 || echo $?
halflight render rings.nrrd --views front --view left -o no.png 2>&1 || echo $?
halflight render rings.nrrd --views front,left -o no.exr 2>&1 || echo $?
halflight render rings.nrrd --views front,left 2>&1 || echo $?
ls
# All views of a sheet have one scale: a bar three times as long as wide is as high from the left as from the front, in either perspective.
"$PYTHON" -c 'open("bar_24x8x8_uint8.raw", "wb").write(bytes(255 * (2 <= x < 22 and 2 <= y < 6 and 2 <= z < 6) for z in range(8) for y in range(8) for x in range(24)))'
for way in --ortho --fovy=5; do
  halflight render bar_24x8x8_uint8.raw --views left,front --size 150x50 $way --background white --quiet -o bars.png
  "$PYTHON" - "$SOURCE" <<'END'
import sys
sys.path.insert(0, sys.argv[1] + "/tests/cli")
sys.argv[1:] = ["png-header", "bars.png"]
import tool
width, height, channels, rows = tool.png_rows("bars.png")
def high(columns):
    return sum(any(min(row[x * channels:x * channels + 3]) < 200 for x in columns) for row in rows)
left, front = high(range(150)), high(range(width - 150, width))
print("one scale:", abs(left - front) <= 1 and left > 20)
END
done
