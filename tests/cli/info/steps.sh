# A warning names the time step and the channel that are taken, where there are several and none is chosen.
"$PYTHON" - <<'END'
import json, os
def write(name, times, channels):
    os.makedirs(name + "/0")
    json.dump({"zarr_format": 2}, open(name + "/.zgroup", "w"))
    axes = [{"name": n, "type": {"t": "time", "c": "channel"}.get(n, "space")} for n in "tczyx"]
    json.dump({"multiscales": [{"version": "0.4", "axes": axes, "datasets": [{"path": "0"}]}]}, open(name + "/.zattrs", "w"))
    json.dump({"zarr_format": 2, "shape": [times, channels, 4, 4, 4], "chunks": [1, 1, 4, 4, 4], "dtype": "|u1", "compressor": None, "fill_value": 0,
        "order": "C", "filters": None}, open(name + "/0/.zarray", "w"))
    open(name + "/0/0.0.0.0.0", "wb").write(bytes(range(64)))
write("both.zarr", 3, 2)
write("channels.zarr", 1, 2)
write("times.zarr", 3, 1)
write("one.zarr", 1, 1)
END
for name in both channels times one; do halflight info $name.zarr 2>&1 >text; done
halflight info both.zarr --time 0 2>&1 >text
halflight info both.zarr --channel 0 2>&1 >text
halflight info both.zarr --channel 0 --time 0 2>&1 >text
