# --time all: a picture of each time step of one file, with one look and one camera.
"$PYTHON" -c 'import array
values = array.array("B")
for t in range(3):
    values.extend(max(0, 255 - int(9 * ((i - 6 - 2 * t)**2 + (j - 8)**2 + (k - 8)**2))) for k in range(16) for j in range(16) for i in range(16))
header = "{\"descr\": \"|u1\", \"fortran_order\": False, \"shape\": (3, 16, 16, 16)}"
with open("beats.npy", "wb") as file:
    file.write(b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header.replace("\"", chr(39)).encode() + values.tobytes())'
halflight render beats.npy --time all --size 32x32 -o 'all/%d.png' --quiet
ls all
# A picture's scene names its time step, and makes the picture again.
for time in 0 1 2; do
  halflight render all/$time.png --print-scene | grep -o '"time": .'  
  halflight render all/$time.png -o again.png --quiet
  cmp all/$time.png again.png
done
halflight diff all/0.png all/2.png >difference
grep -q "greatest difference 0$" difference && exit 9
# A run goes on where it was, and parts share the work.
rm all/1.png
halflight render beats.npy --time all --size 32x32 -o 'all/%d.png' 2>&1 | sed 's/ in .*//'
halflight render beats.npy --time all --size 32x32 -o 'part/%d.png' --part 2/2 --quiet
ls part
# A film has a frame for each of them.
halflight animate beats.npy --time all --size 32x32 -o frames --quiet
ls frames
cp beats.npy more.npy
halflight render beats.npy more.npy --time all -o '%d.png' && exit 9
halflight render beats.npy --time all -o one.png && exit 9
halflight animate beats.npy -o still.mp4 && exit 9
halflight render beats.npy --time some -o one.png && exit 9
test ! -e one.png
