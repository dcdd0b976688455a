# NaN and infinities are counted, and in no statistic.
"$PYTHON" -c 'import struct, sys
sys.stdout.buffer.write(struct.pack("<8f", 1, 2, 3, 6, float("nan"), float("inf"), float("-inf"), 3))' >x_2x2x2_float32.raw
halflight info x_2x2x2_float32.raw --json >info.json
tool json info.json 'd["range"], d["mean"], d["nonfinite_count"], sum(d["histogram"])'
