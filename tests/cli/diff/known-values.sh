# A 2 x 1 picture against one whose second pixel has 0.5 more red and 0.25 less alpha.
npy() {
  "$PYTHON" -c 'import struct, sys
header = b"{\"descr\": \"<f4\", \"fortran_order\": False, \"shape\": (1, 2, 4), }"
header += b" " * (117 - len(header)) + b"\n"
sys.stdout.buffer.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header)
sys.stdout.buffer.write(struct.pack("<8f", *map(float, sys.argv[1:])))' "$@"
}
npy 0 0 0 1  0.25 0 0 0.5 >a.npy
npy 0 0 0 1  0.75 0 0 0.25 >b.npy
halflight diff a.npy b.npy --json >diff.json
tool json diff.json '[d["maximum"], d["maximum_at"], d["differing_pixels"], d["mean_signed"]]'
tool json diff.json 'abs(d["rmse"] - ((0.25 + 0.0625) / 8) ** 0.5) < 1e-12, d["width"], d["height"], d["within_limits"]'
halflight diff b.npy a.npy --json >back.json
tool json back.json 'd["mean_signed"]'
