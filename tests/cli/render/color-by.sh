# A volume in the colours of another one: its opacities stay, the other volume is in the scene and is not seen, and the
# scene and its threads give the same bytes.
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
for wrong in "no.nrrd" "heat.nrrd:90,20" "heat.nrrd --look mip" "heat.nrrd --iso 90" "heat.nrrd:infernoo" "heat.nrrd:hot:1"; do
  code=0
  ball --color-by $wrong -o no.png 2>message || code=$?
  echo $code "$(cut -c12-180 message)"
done
# The legend's colours go over their own values, also where --range tells the values of matter.
ball --color-by heat.nrrd:inferno --range 20,255 --legend "Heat (K)" --size 200 -o ranged.png
"$PYTHON" -c "from PIL import Image
pixels = Image.open('ranged.png').convert('RGB').getdata()
print(any(r > 240 and g > 240 and 150 < b < 180 for r, g, b in pixels), any(r < 10 and g < 10 and b < 20 for r, g, b in pixels))"
