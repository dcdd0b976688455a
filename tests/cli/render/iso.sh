# Isosurfaces: in place of the transfer function, kept in the scene, by volume; what cannot be is refused.
tool ball 16 a_16x16x16_uint8.raw
tool ball 16 b_16x16x16_uint8.raw
halflight render a_16x16x16_uint8.raw --iso 120:gold --iso 60:0.1,0.2,0.3:0.25 --iso 30 --print-scene >three.json
tool json three.json "[s['value'] for s in d['volumes'][0]['iso']], d['volumes'][0]['iso'][1]"
tool json three.json "max(p[1] for p in d['volumes'][0]['transfer_function']['opacity'])"
halflight render a_16x16x16_uint8.raw --iso 120:gold --iso 60:0.1,0.2,0.3:0.25 --iso 30 --quiet --size 32x32 -o direct.npy
halflight render three.json --quiet --size 32x32 --zoom 1 -o again.npy
halflight diff direct.npy again.npy --max-rmse 0.1 >/dev/null
halflight render a_16x16x16_uint8.raw b_16x16x16_uint8.raw --iso a_16x16x16_uint8=90 --print-scene >one.json
tool json one.json "[len(v.get('iso', [])) for v in d['volumes']]"
halflight render a_16x16x16_uint8.raw --iso 90 --tf ct-bone --quiet --print-scene >both.json
tool json both.json "max(p[1] for p in d['volumes'][0]['transfer_function']['opacity']) > 0"
for iso in gold 120:goldd 120:gold:2 120:gold:0.5:1 nan c=90; do
  code=0
  halflight render a_16x16x16_uint8.raw --iso $iso --quiet -o no.png 2>message || code=$?
  echo $code $(cut -c 1-60 message)
done
code=0
halflight render a_16x16x16_uint8.raw --iso 90 --look mip --quiet -o no.png 2>message || code=$?
echo $code $(cut -c 1-60 message)
halflight render a_16x16x16_uint8.raw --iso 900 --size 16x16 -o none.png 2>message
grep -c "no surface is there" message
