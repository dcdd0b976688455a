# Labels are drawn by the B-spline, the numbers of a label map linearly; --kernel is heeded.
"$PYTHON" -c '
import struct
header = b"{\"descr\": \"|u1\", \"fortran_order\": False, \"shape\": (24, 24, 24), }".ljust(117) + b"\n"
def label(x, y, z):
    return 1 + (x > 8) + 2 * (y > 15) + 4 * (z > 11) if 3 < x < 21 and 3 < y < 21 and 3 < z < 21 else 0
voxels = bytes(label(x, y, z) for z in range(24) for y in range(24) for x in range(24))
open("labels.npy", "wb").write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + voxels)'
halflight render labels.npy --colormap viridis --print-scene | grep '"kernel"'
halflight render labels.npy --show all --print-scene | grep '"kernel"'
halflight render labels.npy --show all --kernel gaussian --print-scene | grep '"kernel"'
