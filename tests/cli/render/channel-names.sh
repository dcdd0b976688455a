# Names of channels may hold commas: the longest name that fits counts, in lists, too.
"$PYTHON" - <<'END'
import json, pathlib
store = pathlib.Path("cells.zarr")
(store / "0").mkdir(parents=True)
names = ["DAPI", "DAPI, deep", "GFP, mem, left"]
axes = [{"name": "c", "type": "channel"}] + [{"name": a, "type": "space"} for a in "zyx"]
(store / ".zgroup").write_text('{"zarr_format": 2}')
(store / ".zattrs").write_text(json.dumps({
    "multiscales": [{"version": "0.4", "axes": axes, "datasets": [
        {"path": "0", "coordinateTransformations": [{"type": "scale", "scale": [1, 1, 1, 1]}]}]}],
    "omero": {"channels": [{"label": name, "color": color} for name, color in zip(names, ["FF0000", "00FF00", "0000FF"])]}}))
(store / "0/.zarray").write_text(json.dumps({
    "zarr_format": 2, "shape": [3, 8, 8, 8], "chunks": [1, 8, 8, 8], "dtype": "|u1", "compressor": None, "fill_value": 0,
    "order": "C", "filters": None, "dimension_separator": "."}))
for c in range(3):
    (store / f"0/{c}.0.0.0").write_bytes(bytes((c + 1) * (i + j + k) for k in range(8) for j in range(8) for i in range(8)))
END
shown() {
  halflight render cells.zarr --channel "$1" --print-scene >scene.json 2>message || { cut -c1-110 message; return 0; }
  tool json scene.json "[(v['name'], v.get('channel')) for v in d['volumes']]"
}
shown "DAPI, deep"
shown "DAPI,GFP, mem, left"
shown "GFP, mem, left,DAPI, deep,0"
shown "2,1"
shown "DAPI,GFP"
shown "0,0"
