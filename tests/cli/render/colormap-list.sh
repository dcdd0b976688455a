# A list of colormaps and colours has one for each volume, in order; R,G,B stays one colour.
tool ball 16 one_16x16x16_uint8.raw
cp one_16x16x16_uint8.raw two_16x16x16_uint8.raw
scene() { halflight render one_16x16x16_uint8.raw two_16x16x16_uint8.raw "$@" --print-scene; }
scene --colormap magma,tomato >list.json
scene --colormap one_16x16x16_uint8=magma --colormap two_16x16x16_uint8=tomato >named.json
cmp list.json named.json
scene --colormap 1,0.5,0 >color.json
tool json color.json '[v["transfer_function"]["color"] for v in d["volumes"]]'
for wrong in magma,tomato,blue magma,nothing one_16x16x16_uint8=magma,tomato; do
  scene --colormap $wrong 2>&1 || echo $?
done
halflight render one_16x16x16_uint8.raw --colormap magma,tomato 2>&1 || echo $?
