# --smooth: in the scene that it makes, which gives the same bytes; 0 leaves voxels as they are; label maps are refused.
"$PYTHON" - <<'PY'
import random
random.seed(1)
n, voxels = 24, bytearray()
for k in range(n):
    for j in range(n):
        for i in range(n):
            inside = (i - 11) ** 2 + (j - 12) ** 2 + (k - 11) ** 2 < 81
            voxels.append(130 + random.randrange(40) if inside else 0)
open("cut_24x24x24_uint8.raw", "wb").write(voxels)
open("map_24x24x24_uint8.raw", "wb").write(bytes(0 if v == 0 else 1 + (n % 24 > 11) for n, v in enumerate(voxels)))
PY
halflight convert cut_24x24x24_uint8.raw cut.nii --quiet
for sigma in "" 0 1.5; do
  halflight render cut.nii ${sigma:+--smooth $sigma} --size 32x32 --print-scene >scene.json
  tool json scene.json "d['volumes'][0].get('smooth')"
  halflight render cut.nii ${sigma:+--smooth $sigma} --size 32x32 --quiet -o a.npy
  halflight render scene.json --quiet -o b.npy
  cmp a.npy b.npy
done
for input in "map_24x24x24_uint8.raw --smooth 1" "cut.nii --smooth 17" "scene.json --smooth 1"; do
  code=0
  halflight render $input --quiet -o no.png 2>message || code=$?
  echo "$code $(cat message)"
done
