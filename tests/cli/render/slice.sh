# A slice shows the values at its plane, to an eighth of a voxel. Each ramp has 16 times the voxel's number along an axis.
"$PYTHON" - <<'END'
n = 16
for axis in range(4):  # the last ramp has a slope of 2 along x and of 4 along y
    with open(f"ramp-{'xyzw'[axis]}.nrrd", "wb") as file:
        file.write(f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {n} {n} {n}\nencoding: raw\n\n".encode())
        file.write(bytes(2 * i + 4 * j if axis == 3 else 16 * (i, j, k)[axis]
                         for k in range(n) for j in range(n) for i in range(n)))
END
cat >pixel.py <<'END'
import ast, struct, sys
data = open("slice.npy", "rb").read()
length, = struct.unpack("<H", data[8:10])
height, width, channels = ast.literal_eval(data[10:10 + length].decode())["shape"]
numbers = struct.unpack(f"<{height * width * channels}f", data[10 + length:])
def value(x, y):
    light = numbers[channels * (y * width + x)]
    return 255 * (12.92 * light if light < 0.0031308 else 1.055 * light ** (1 / 2.4) - 0.055)
END
slice() { halflight render "$@" --range 0,255 --size 160 --quiet -o slice.npy; }
for at in x=3 y=7.5 z=7.5 z=12; do
  for side in "" --view; do
    case $side$at in --viewx*) side="--view left" ;; --viewy*) side="--view back" ;; --viewz*) side="--view bottom" ;; esac
    slice ramp-${at%=*}.nrrd --slice ${at}u $side
    "$PYTHON" -c "exec(open('pixel.py').read()); print(abs(value(80, 80) / 16 - ${at#*=}) <= 0.125)"
  done
done
# From the top x goes to the right and y up; from the bottom y goes down, as the rows of a file of slices do. The slope
# along y is twice the slope along x.
for side in top bottom; do
  slice ramp-w.nrrd --slice z=0.5 --view $side
  "$PYTHON" -c "exec(open('pixel.py').read())
right, up = value(100, 80) - value(60, 80), value(80, 60) - value(80, 100)
print(right > 0, round(up / right, 1))"
done
# A slice and the whole volume are seen from the same side, with the same side up, unless the file knows a body: its
# slices across z are seen from the feet, and a line says so.
camera() { halflight render "$@" --print-scene >scene.json; tool json scene.json '[[round((p - t) / max(abs(q - u) for q, u in zip(d["camera"]["position"], d["camera"]["target"])), 6) + 0 for p, t in zip(d["camera"]["position"], d["camera"]["target"])], [round(u, 6) + 0.0 for u in d["camera"]["up"]]]'; }
{ printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16 16 16\nspace: RAS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nencoding: raw\n\n'; tail -c 4096 ramp-w.nrrd; } >body.nrrd
for file in ramp-w body; do
  for axis in z,top z,bottom y,front y,back x,left x,right; do
    slice=$(camera $file.nrrd --slice ${axis%,*} --view ${axis#*,} 2>slice-said)
    whole=$(camera $file.nrrd --up +z --view ${axis#*,} 2>/dev/null)
    echo $file $axis $(test "$slice" = "$whole" && echo agrees || echo "$slice, but $whole") $(cut -d: -f1 slice-said)
  done
done
halflight render body.nrrd --view top --size 16 -o top.png 2>&1 | grep -o '^seen from the head: [^;]*'
halflight render body.nrrd --slice axial --size 16 -o axial.png 2>&1 | grep -o '^seen from the feet[^;]*'
halflight render ramp-w.nrrd --slice z --size 16 -o z.png 2>&1 | grep -o '^seen from the top, [^;]*'
# Labels lie over the values, and do not replace them; several volumes have a colour each, and one volume is grey.
tool atlas 16 map.nrrd
halflight render ramp-w.nrrd --slice z=0.5 --labels map.nrrd --size 64 --quiet -o labels.png
tool png-pixel labels.png 28 28
halflight render ramp-w.nrrd --slice z=0.5 --size 64 --quiet -o alone.png
tool png-pixel alone.png 28 28
for wrong in "z=2" "w=0.5" "z=0.5 --look mip" "z=0.5 --view left" "0.5"; do
  code=0
  halflight render ramp-w.nrrd --slice $wrong 2>message || code=$?
  echo $code; cut -c1-110 message
done
