# A byte-order mark before UTF-8, as Windows programs write it, changes nothing: in scenes, looks, shapes and text headers.
tool ball 16 ball_16x16x16_uint8.raw
marked() { printf '\357\273\277'; cat; }
printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16 16 16\nencoding: raw\n\n' | cat - ball_16x16x16_uint8.raw >plain.nrrd
marked <plain.nrrd >ball.nrrd
echo '{ "opacity": [[100, 0], [200, 1]], "color": [[0, 1, 1, 1]] }' | marked >look.json
echo '{ "halflight": 1, "volumes": [ { "file": "ball.nrrd", "transfer_function": { "file": "look.json" } } ] }' | marked >scene.json
halflight render scene.json --size 16x16 --quiet -o marked.npy
for file in ball.nrrd look.json scene.json; do tail -c +4 $file >plain && mv plain $file; done
halflight render scene.json --size 16x16 --quiet -o plain.npy
cmp marked.npy plain.npy
echo '{ "shapes": [ { "type": "sphere", "radius": 9 } ] }' | marked >shape.json
halflight make shape.json --size 16 --quiet -o shape.nrrd
