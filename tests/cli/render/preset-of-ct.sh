# A preset of CT says so where the values are no Hounsfield units; where they are, it says nothing.
tool ball 16 ball_16x16x16_uint8.raw
"$PYTHON" - <<'END'
import struct
values = [800 if (i - 8) ** 2 + (j - 8) ** 2 + (k - 8) ** 2 < 9 else 40 if (i - 8) ** 2 + (j - 8) ** 2 + (k - 8) ** 2 < 36 else -1000
          for k in range(16) for j in range(16) for i in range(16)]
with open("ct.nrrd", "wb") as file:
    file.write(b"NRRD0004\ntype: int16\ndimension: 3\nsizes: 16 16 16\nencoding: raw\nendian: little\n\n")
    file.write(struct.pack("<4096h", *values))
END
for file in ball_16x16x16_uint8.raw ct.nrrd; do
  for preset in ct-bone mr-brain; do
    halflight render $file --tf $preset --print-scene 2>message >scene.json
    echo "$file $preset $(grep -c "made for CT" message)"
  done
done
