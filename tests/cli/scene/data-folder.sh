# data:NAME is in --data, else in HALFLIGHT_DATA, else in ../shared/data; where it is absent, the stand-in is shown.
mkdir -p here/near shared/data/near run
tool ball 16 here/near/ball_16x16x16_uint8.raw
cat >run/scene.json <<END
{ "halflight": 1, "image": { "width": 32, "height": 32 },
  "volumes": [ { "file": "data:near/ball_16x16x16_uint8.raw",
                 "stand_in": { "shapes": [ { "type": "box", "size": [1, 1, 1] } ] } } ] }
END
cd run
halflight render scene.json --data ../here --quiet -o a.npy
HALFLIGHT_DATA=../here halflight render scene.json --quiet -o b.npy
cmp a.npy b.npy
halflight render scene.json -o c.npy 2>messages
head -n 1 messages
if cmp -s a.npy c.npy; then exit 1; fi
cp ../here/near/* ../shared/data/near
halflight render scene.json --quiet -o d.npy
cmp a.npy d.npy
