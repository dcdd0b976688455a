# A NumPy array is a volume: axes [z][y][x], in either order.
"$PYTHON" - <<'END'
import math
n = 12
ball = [[[max(0, min(255, int(128 + 64 * (4 - math.dist((x, y, 2 * z), (6, 5, 12)))))) for x in range(n)] for y in range(n)] for z in range(n)]
def write(name, order, values):
    header = f"{{'descr': '|u1', 'fortran_order': {order}, 'shape': ({n}, {n}, {n}), }}".ljust(117) + "\n"
    open(name, "wb").write(b"\x93NUMPY\1\0" + len(header).to_bytes(2, "little") + header.encode() + bytes(values))
everything = range(n)
write("c.npy", False, [ball[z][y][x] for z in everything for y in everything for x in everything])
write("f.npy", True, [ball[z][y][x] for x in everything for y in everything for z in everything])
open("r_12x12x12_uint8.raw", "wb").write(bytes(ball[z][y][x] for z in everything for y in everything for x in everything))
END
for volume in c.npy f.npy r_12x12x12_uint8.raw; do
  halflight render $volume --size 20x20 --quiet -o "picture-${volume%%.*}.npy"
done
cmp picture-c.npy picture-f.npy
cmp picture-c.npy picture-r_12x12x12_uint8.npy
