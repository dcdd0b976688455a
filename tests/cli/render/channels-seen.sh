# A channel that would hide another one is translucent, whatever the order of the channels, and a line says so. Channels beside each other, and
# channels whose opacities are asked for or that are cut open, stay as they are. A range of values asks for no opacities.
# slow: 4 seconds of processor time
"$PYTHON" - <<'END'
import json, math, os
def write(name, *channels):
    os.makedirs(name + "/0")
    json.dump({"zarr_format": 2}, open(name + "/.zgroup", "w"))
    json.dump({"multiscales": [{"version": "0.4", "axes": [{"name": n, "type": "channel" if n == "c" else "space"} for n in "czyx"],
        "datasets": [{"path": "0"}]}], "omero": {"channels": [{"label": label} for label, _ in channels]}}, open(name + "/.zattrs", "w"))
    json.dump({"zarr_format": 2, "shape": [2, 32, 32, 32], "chunks": [1, 32, 32, 32], "dtype": "|u1", "compressor": None, "fill_value": 0,
        "order": "C", "filters": None}, open(name + "/0/.zarray", "w"))
    for number, (_, value) in enumerate(channels):
        with open(f"{name}/0/{number}.0.0.0", "wb") as file:
            file.write(bytes(max(0, min(255, round(value(x, y, z)))) for z in range(32) for y in range(32) for x in range(32)))
def ball(x, y, z, at, radius): return 128 + 64 * (radius - math.dist((x, y, z), (at, 15.5, 15.5)))
core = "core", lambda x, y, z: ball(x, y, z, 15.5, 5)
skin = "skin", lambda x, y, z: min(ball(x, y, z, 15.5, 13), 255 - ball(x, y, z, 15.5, 10))
left, right = [(name, lambda x, y, z, at=at: ball(x, y, z, at, 6)) for name, at in (("left", 8), ("right", 23))]
write("within.zarr", core, skin)
write("around.zarr", skin, core)
write("beside.zarr", left, right)
with open("map_32x32x32_uint8.raw", "wb") as file:
    file.write(bytes(core[1](x, y, z) > 128 for z in range(32) for y in range(32) for x in range(32)))
END
for radius in 7 14; do
  "$PYTHON" -c "
import math
open('mask${radius}_32x32x32_uint8.raw', 'wb').write(bytes(math.dist((x, y, z), (15.5, 15.5, 15.5)) < $radius
    for z in range(32) for y in range(32) for x in range(32)))"
done
told() {
  echo "$*: $(halflight render "$@" --channel all --print-scene 2>&1 >scene.json)"
  tool json scene.json '[(v["name"], "translucent" if v["transfer_function"].get("unit_distance", 1) > 5 else "opaque") for v in d["volumes"] if "labels" not in v]'
}
told within.zarr
told around.zarr
told beside.zarr
told within.zarr --look surface
told within.zarr --look mip
told within.zarr --look auto
told within.zarr --threshold 100
told within.zarr --range 1%,99%
told within.zarr --colormap cyan,magenta
told within.zarr --cut-box z=0.5: --view top
# A mask that leaves the skin leaves it translucent, and one that leaves the core alone leaves nothing that hides it.
told within.zarr --mask mask14_32x32x32_uint8.raw
told within.zarr --mask mask7_32x32x32_uint8.raw
# Matter that is clipped away counts no more: the skin hides what is left of the core.
told within.zarr --clip x=:0.5 --view front
# Labels beside the channels change nothing; where they are hidden, the line names the channel that hides them.
told within.zarr --labels map_32x32x32_uint8.raw
told within.zarr --labels map_32x32x32_uint8.raw --look surface
told around.zarr --labels map_32x32x32_uint8.raw --look surface
# The core is seen in the picture: pixels in its colour, magenta, over the skin's green.
halflight render around.zarr --channel all --size 64 --quiet -o around.png 2>/dev/null
tool png-pixel around.png 32 32 | "$PYTHON" -c 'red, green, blue = map(int, input().split()); print("magenta:", red > 1.1 * green and blue > 1.1 * green)'
# `looks` shows the channels together, too, each look with the options that `render` has.
halflight looks around.zarr --channel all --look auto,surface --size 64 --quiet -o looks.png
tool png-pixel looks.png 32 32 | "$PYTHON" -c 'red, green, blue = map(int, input().split()); print("magenta:", red > 1.1 * green and blue > 1.1 * green)'
tool png-pixel looks.png 96 32 | "$PYTHON" -c 'red, green, blue = map(int, input().split()); print("green:", green > 3 * red and green > 3 * blue)'
for channels in 1 core 0,CORE 0,7 x 0,; do
  halflight looks around.zarr --channel $channels --look surface --size 16 --quiet -o looks.png 2>&1 || true
done
