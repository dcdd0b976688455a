# A volume in the colours of another one: its opacities stay, the other volume is in the scene and is not seen, and the
# scene and its threads give the same bytes.
# slow: 4 seconds of processor time
tool ball 16 ball_16x16x16_uint8.raw
"$PYTHON" - <<'END'
with open("heat.nrrd", "wb") as file:
    file.write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16 16 16\nencoding: raw\n\n")
    file.write(bytes(10 * i for k in range(16) for j in range(16) for i in range(16)))
END
ball() { halflight render ball_16x16x16_uint8.raw --quiet "$@"; }
ball --print-scene >plain.json
ball --color-by heat.nrrd --print-scene >whole.json
ball --color-by heat.nrrd:inferno --print-scene >map.json
ball --color-by heat.nrrd:inferno:20,90 --print-scene >range.json
tool json whole.json "[(v['name'], v['visible']) for v in d['volumes'][1:]]"
for scene in whole map range; do
  tool json $scene.json "(lambda c: (c[0][0], c[-1][0], [round(x, 3) for x in c[-1][1:]]))(d['volumes'][0]['transfer_function']['curves']['color'])"
done
"$PYTHON" - <<'END'
import json
function = [json.load(open(name))["volumes"][0]["transfer_function"] for name in ("plain.json", "whole.json")]
print(function[1]["second"], function[0]["opacity"] == function[1]["curves"]["opacity"], "opacity" in function[1])
END
ball --color-by heat.nrrd --size 32 -o direct.npy
halflight render whole.json --size 32 --zoom 1 --quiet -o again.npy
ball --color-by heat.nrrd --size 32 --threads 1 -o one.npy
cmp direct.npy one.npy
halflight diff direct.npy again.npy --max-rmse 0.01 >/dev/null
ball --color-by heat.nrrd --size 32 --legend "Heat (K)" -o legend.png
# The sheets are the reference's to the reference's own noise.
ball --color-by heat.nrrd --size 12 --sky 0 --shadows off -o sheets.npy
ball --color-by heat.nrrd --size 12 --sky 0 --shadows off --reference -o exact.npy
halflight diff exact.npy sheets.npy --max-rmse 0.02 >/dev/null
# An array of the input's own file, by its name or its file's; a part that is a map is the map.
cat >flame.vti <<'END'
<VTKFile type="ImageData"><ImageData WholeExtent="0 1 0 1 0 1"><PointData>
<DataArray type="UInt8" Name="heat">0 2 3 4 5 6 7 200</DataArray><DataArray type="UInt8" Name="OH">8 7 6 5 4 3 2 10</DataArray>
<DataArray type="UInt8" Name="a:b">8 7 6 5 4 3 2 20</DataArray>
</PointData></ImageData></VTKFile>
END
for by in OH OH:hot:2,9 flame.vti:OH flame.vti:OH:inferno:2,9 flame.vti:a:b a:b:inferno; do
  halflight render flame.vti --array heat --threshold 100 --color-by $by --print-scene >arrays.json
  tool json arrays.json "[(v.get('array'), v['file'], v['name']) for v in d['volumes'][1:]], (lambda c: (c[0][0], c[-1][0], [round(x, 2) for x in c[-1][1:]]))(d['volumes'][0]['transfer_function']['curves']['color'])"
done
halflight render flame.vti --array heat --threshold 100 --color-by OH --size 24 --quiet -o named.npy
halflight render flame.vti --array heat --threshold 100 --color-by flame.vti:OH --size 24 --quiet -o filed.npy
cmp named.npy filed.npy
# A scene keeps the array.
halflight render arrays.json --size 24 --quiet -o kept.npy
for by in OHH flame.vti:OHH; do
  code=0
  halflight render flame.vti --array heat --color-by $by -o no.png 2>message || code=$?
  echo $code "$(cut -c12-200 message)"
done
for wrong in "no.nrrd" "heat.nrrd:90,20" "heat.nrrd --look mip" "heat.nrrd:infernoo" "heat.nrrd:hot:1"; do
  code=0
  ball --color-by $wrong -o no.png 2>message || code=$?
  echo $code "$(cut -c12-180 message)"
done
# Below a threshold, and between two numbers, the matter keeps its own colours.
flat() { ball --shading flat --kernel linear --ortho --view front --size 64 "$@"; }
flat -o own.npy
flat --color-by heat.nrrd:inferno:20,150 -o mapped.npy
flat --color-by heat.nrrd:inferno:20,150 --color-by-threshold 80 -o above.npy
flat --color-by heat.nrrd:inferno:20,150 --color-by-threshold 60,100 -o beside.npy
"$PYTHON" - <<'END'
import numpy as np
own, mapped, above, beside = (np.load(name + ".npy") for name in ("own", "mapped", "above", "beside"))
seen = own[..., 3] > 0.5
x = np.nonzero(seen.any(axis=0))[0]
low, high = x.min(), x.max() + 1
heat = (np.arange(64) + 0.5 - low) / (high - low) * 150  # where the ball is seen, up to a few pixels
same = lambda a, b, columns: bool(np.abs(a - b)[:, columns].max() < 2e-3)
print(same(above, own, heat < 60), same(above, mapped, heat > 100), same(above, own, heat > 100))
print(same(beside, mapped, heat < 40), same(beside, own, abs(heat - 80) < 5), same(beside, mapped, heat > 120))
END
ball --color-by heat.nrrd:inferno:20,150 --color-by-threshold 80 --print-scene >kept.json
tool json kept.json "(lambda c: (c['own_between'], len(c['own_color']) > 0))(d['volumes'][0]['transfer_function']['curves'])"
ball --color-by heat.nrrd:inferno:20,150 --color-by-threshold 80 --size 12 --sky 0 --shadows off -o sheets.npy
ball --color-by heat.nrrd:inferno:20,150 --color-by-threshold 80 --size 12 --sky 0 --shadows off --reference -o exact.npy
halflight diff exact.npy sheets.npy --max-rmse 0.02 >/dev/null
for wrong in "--color-by-threshold 80" "--color-by heat.nrrd --color-by-threshold 9,2"; do
  code=0
  ball $wrong -o no.png 2>message || code=$?
  echo $code "$(cut -c12-180 message)"
done
ball --color-by heat.nrrd:hot:100,150 --size 8 --print-scene >first.json 2>message
halflight render ball_16x16x16_uint8.raw --color-by heat.nrrd:hot:100,150 --size 8 -o first.png 2>message
grep threshold message
# An isosurface has the colours, too, or its own one below the threshold: the reference's, but for the pixels of edges.
for threshold in "" "--color-by-threshold 80"; do
  iso() { ball --iso 90:gold --color-by heat.nrrd:inferno:20,150 $threshold --size 24 --sky 0 --shadows off --shading flat --ortho --view front "$@"; }
  iso -o sheets.npy
  iso --reference -o exact.npy
  "$PYTHON" -c "import numpy as np
exact, sheets = np.load('exact.npy'), np.load('sheets.npy')
apart = np.abs(exact - sheets)[(exact[..., 3] == 1) & (sheets[..., 3] == 1)].max(axis=1)
print(len(apart) > 200, np.median(apart) < 2e-3, (apart > 0.03).mean() < 0.1)"
  iso --print-scene >iso.json
  tool json iso.json "d['volumes'][0]['iso']"
  halflight render iso.json --quiet -o again.npy
  cmp sheets.npy again.npy
done
# The legend's colours go over their own values, also where --range tells the values of matter.
ball --color-by heat.nrrd:inferno --range 20,255 --legend "Heat (K)" --size 200 -o ranged.png
"$PYTHON" -c "from PIL import Image
pixels = Image.open('ranged.png').convert('RGB').getdata()
print(any(r > 240 and g > 240 and 150 < b < 180 for r, g, b in pixels), any(r < 10 and g < 10 and b < 20 for r, g, b in pixels))"
