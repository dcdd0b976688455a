# At a terminal, a label map that is drawn by value names the option that draws each label by itself.
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
print(b"--labels FILE" in kept)' "$HALFLIGHT"
