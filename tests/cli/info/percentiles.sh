# Percentiles tell the values in which nearly all voxels lie, where a bright speck makes the range and its histogram useless. Of the numbers 0 to 999,
# p percent is 9.99 p. The 99.9th percentile of 100,000 voxels lies between the 101st and the 100th from the top.
"$PYTHON" - <<'END'
open("ramp_10x10x10_uint16.raw", "wb").write(b"".join(n.to_bytes(2, "little") for n in range(1000)))
values = [7] * 99899 + [60000] * 101
open("specks_100x100x10_uint16.raw", "wb").write(b"".join(n.to_bytes(2, "little") for n in values))
END
for name in ramp_10x10x10 specks_100x100x10; do
  halflight info ${name}_uint16.raw | grep percentiles
  halflight info ${name}_uint16.raw --json >info.json
  tool json info.json '{name: round(value, 9) for name, value in d["percentiles"].items()}'
done
