# "all" and "rest" are the labels that the list does not name, wherever they stand in it. Their opacity is that of all of them along a typical way:
# through eight blocks a way meets two and crosses four skins, and 1 - 0.9^4 is 0.3439. In a mask, "all" leaves each label its own.
"$PYTHON" -c 'open("map.nrrd", "wb").write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\n\n" + bytes(
    1 + x // 4 + 2 * (y // 4) + 4 * (z // 4) for z in range(8) for y in range(8) for x in range(8)))'
for shown in 3=red,all:0.3439 rest:0.3439,3 all; do
  halflight render map.nrrd --show $shown --print-scene 2>/dev/null >scene.json
  tool json scene.json "[(l['value'], round(l.get('opacity', 1), 6)) for l in d['volumes'][0]['labels'] if l.get('visible', True)]"
done
halflight render map.nrrd --mask map.nrrd --show all:0.19 --print-scene 2>/dev/null >scene.json
tool json scene.json "sorted({round(l.get('opacity', 1), 6) for l in d['volumes'][0]['mask']['labels']})"
# A scan that a table makes a label map: a warning.
tool ball 16 ball_16x16x16_uint8.raw
echo "255,ball,255,0,0" >table.csv
halflight render ball_16x16x16_uint8.raw --label-table table.csv --size 16x16 -o p.png
# A way through one label crosses its skin twice: half of the light is left behind it.
"$PYTHON" -c 'open("one.nrrd", "wb").write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 32 32 32\nencoding: raw\n\n" + bytes(
    max(abs(2 * x - 31), abs(2 * y - 31), abs(2 * z - 31)) < 24 for z in range(32) for y in range(32) for x in range(32)))'
halflight render one.nrrd --show all:0.5 --view front --ortho --shadows off --background transparent --size 33 --quiet -o one.npy
"$PYTHON" -c 'import numpy; print(abs(numpy.load("one.npy")[16, 16, 3] - 0.5) < 0.03)'
