# "all" and "rest" are the labels that the list does not name, wherever they stand in it. Their opacity is that of all of them along a typical way:
# through eight blocks a way meets two, and 1 - 0.9 x 0.9 is 0.19. In a mask, "all" leaves each label its own.
"$PYTHON" -c 'open("map.nrrd", "wb").write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\n\n" + bytes(
    1 + x // 4 + 2 * (y // 4) + 4 * (z // 4) for z in range(8) for y in range(8) for x in range(8)))'
for shown in 3=red,all:0.19 rest:0.19,3 all; do
  halflight render map.nrrd --show $shown --print-scene 2>/dev/null >scene.json
  tool json scene.json "[(l['value'], round(l.get('opacity', 1), 6)) for l in d['volumes'][0]['labels'] if l.get('visible', True)]"
done
halflight render map.nrrd --mask map.nrrd --show all:0.19 --print-scene 2>/dev/null >scene.json
tool json scene.json "sorted({round(l.get('opacity', 1), 6) for l in d['volumes'][0]['mask']['labels']})"
# A scan that a table makes a label map: a warning.
tool ball 16 ball_16x16x16_uint8.raw
echo "255,ball,255,0,0" >table.csv
halflight render ball_16x16x16_uint8.raw --label-table table.csv --size 16x16 -o p.png
