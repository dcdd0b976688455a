# "rest:0.5" beside --mask: matter outside of the labels has half the opacity along a way through it, faint or dense, and none or all of it for 0 and 1.
"$PYTHON" -c 'import struct
def write(name, value):
    header = b"{\x27descr\x27: \x27|u1\x27, \x27fortran_order\x27: False, \x27shape\x27: (24, 24, 24), }"
    header += b" " * (117 - len(header)) + b"\n"
    voxels = bytes(value(x, y, z) for z in range(24) for y in range(24) for x in range(24))
    open(name, "wb").write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + voxels)
write("matter.npy", lambda x, y, z: 1 + (x + y + z) % 2)
write("mask.npy", lambda x, y, z: x < 2)'
for opacity in 0.01 0.3; do
  echo "{\"opacity\": [[0, $opacity]], \"color\": [1, 1, 1], \"unit_distance\": 1}" >tf.json
  for rest in 0 0.1 0.5 1; do
    halflight render matter.npy --mask mask.npy --show 1,rest:$rest --tf tf.json --view front --ortho --size 33x33 --quiet -o p.npy
    "$PYTHON" - $opacity $rest <<'END'
import struct, sys
opacity, rest = map(float, sys.argv[1:])
data = open("p.npy", "rb").read()
begin = 10 + struct.unpack("<H", data[8:10])[0]
alpha = struct.unpack_from("<f", data, begin + 16 * (33 * 16 + 20) + 12)[0]
wanted = rest * (1 - (1 - opacity) ** 24)
print(opacity, rest, "as asked" if abs(alpha - wanted) < 0.01 else (alpha, wanted))
END
  done
done
