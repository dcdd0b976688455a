# Looks by name: of bare volumes, of a scene, and all of them on a contact sheet.
# slow: a dozen frames
tool ball 16 a_16x16x16_uint8.raw
for look in auto surface translucent xray smoke vessels; do
  halflight render a_16x16x16_uint8.raw --look $look --print-scene >$look.json
  tool json $look.json "d['volumes'][0]['shading'], d['image']['background'] == [0, 0, 0]"
done
halflight render a_16x16x16_uint8.raw --print-scene >plain.json
cmp plain.json auto.json
halflight render plain.json --look xray --print-scene >changed.json
tool json changed.json "d['volumes'][0]['shading']"
halflight render plain.json --look xray --shading phong --print-scene >phong.json
tool json phong.json "d['volumes'][0]['shading']"
halflight looks a_16x16x16_uint8.raw --size 32 --quiet
test -s a_16x16x16_uint8-looks.png
halflight looks a_16x16x16_uint8.raw --size 32 --quiet -o sheet.npy
"$PYTHON" -c "import struct;print(b\"'shape': (104, 128, 4)\" in open('sheet.npy','rb').read(128))"
for input in plain.json absent.nrrd; do
  code=0
  halflight looks $input --quiet -o no.png 2>message || code=$?
  echo $code $(cat message)
done
# Some of them, side by side.
halflight looks a_16x16x16_uint8.raw --size 32 --quiet --look translucent,surface,mip -o three.npy
"$PYTHON" -c "print(b\"'shape': (52, 96, 4)\" in open('three.npy','rb').read(128))"
code=0
halflight looks a_16x16x16_uint8.raw --look surface,glass --quiet -o no.png 2>message || code=$?
echo $code $(cat message)
