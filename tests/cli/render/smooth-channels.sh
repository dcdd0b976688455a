# Slices and maximum projections show the voxels of the file, of one channel, of several and of several files alike. All
# else of a noisy scan is smoothed, and --smooth holds for each of the channels and files.
"$PYTHON" - <<'END'
import json, math, os, random
random.seed(1)
os.makedirs("cells.zarr/0")
json.dump({"zarr_format": 2}, open("cells.zarr/.zgroup", "w"))
json.dump({"multiscales": [{"version": "0.4", "axes": [{"name": n, "type": "channel" if n == "c" else "space"} for n in "czyx"],
    "datasets": [{"path": "0"}]}]}, open("cells.zarr/.zattrs", "w"))
json.dump({"zarr_format": 2, "shape": [2, 24, 24, 24], "chunks": [1, 24, 24, 24], "dtype": "|u1", "compressor": None, "fill_value": 0,
    "order": "C", "filters": None}, open("cells.zarr/0/.zarray", "w"))
def value(x, y, z, at):
    ball = 128 + 40 * (6 - math.dist((x, y, z), (at, 11.5, 11.5)))
    return round(max(0, min(235, max(20, min(200, ball)) + random.gauss(0, 12))))
for channel, at in enumerate((8, 15)):
    voxels = bytes(value(x, y, z, at) for z in range(24) for y in range(24) for x in range(24))
    for name in f"cells.zarr/0/{channel}.0.0.0", f"c{channel}_24x24x24_uint8.raw":
        with open(name, "wb") as file:
            file.write(voxels)
END
smoothed() {
  halflight render "$@" --size 32x32 --print-scene >scene.json 2>log
  echo "$*: $(tool json scene.json '[v.get("smooth") for v in d["volumes"]]' | sed 's/_24x24x24_uint8.raw//g')"
}
for input in "cells.zarr --channel 1" "cells.zarr --channel all" "c0_24x24x24_uint8.raw c1_24x24x24_uint8.raw"; do
  smoothed $input
  smoothed $input --slice z=0.5
  smoothed $input --look mip
  for sigma in 0 1.5; do
    smoothed $input --smooth $sigma
    smoothed $input --smooth $sigma --look mip
    smoothed $input --smooth $sigma --slice z=0.5
  done
done
# The scene of a projection gives the same picture, and so does a sheet of looks, in which the other looks are smoothed.
halflight render cells.zarr --channel all --look mip --size 32x32 --quiet -o a.npy
halflight render cells.zarr --channel all --look mip --size 32x32 --print-scene >scene.json
halflight render scene.json --quiet -o b.npy
cmp a.npy b.npy
for sigma in "" "--smooth 0" "--smooth 0.8"; do
  halflight render cells.zarr --channel 0 --look mip --size 32x32 --quiet $sigma -o "mip$sigma.npy"
done
cmp mip.npy "mip--smooth 0.npy"
cmp -s mip.npy "mip--smooth 0.8.npy" || echo "smoothing changes a projection"
# A channel that has no mean is refused by its name.
code=0
"$PYTHON" -c 'open("cells.zarr/0/1.0.0.0", "wb").write(bytes((x > 8) + (x > 16) for z in range(24) for y in range(24) for x in range(24)))'
halflight render cells.zarr --channel all --smooth 1 --quiet -o no.png 2>message || code=$?
echo "$code $(cat message)"
