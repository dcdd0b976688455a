# A bare label map is drawn by its labels, as --show all draws it; at a terminal, the options for other pictures are named.
"$PYTHON" -c 'import struct
header = b"{\x27descr\x27: \x27|u1\x27, \x27fortran_order\x27: False, \x27shape\x27: (24, 24, 24), }"
header += b" " * (117 - len(header)) + b"\n"
def label(x, y, z):
    return 0 if not all(4 <= c < 20 for c in (x, y, z)) else 1 + (x >= 12) + 2 * (y >= 12)
voxels = bytes(label(x, y, z) for z in range(24) for y in range(24) for x in range(24))
open("labels.npy", "wb").write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + voxels)'
"$PYTHON" -c 'import os, pty, sys
kept = b""
pid, fd = pty.fork()
if pid == 0:
    os.execv(sys.argv[1], [sys.argv[1], "render", "labels.npy", "--size", "32x32", "-o", "p.png"])
try:
    while data := os.read(fd, 1024):
        kept += data
except OSError: # the terminal of a process that has ended
    pass
os.waitpid(pid, 0)
print(b"taken for labels" in kept, b"--look surface" in kept)' "$HALFLIGHT"
halflight render labels.npy --size 64x64 --no-metadata --quiet -o bare.png
halflight render labels.npy --size 64x64 --no-metadata --quiet -o shown.png --show all
cmp bare.png shown.png && echo the same
halflight render labels.npy --print-scene --quiet | grep -c '"labels"' 
halflight render labels.npy --print-scene --quiet --colormap viridis | grep -c '"labels"' || true
