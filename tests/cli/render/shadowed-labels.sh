# A label whose own name is "rest" or "all" is given by its number: the words keep their meaning, and a warning names the number.
"$PYTHON" -c 'open("map.nrrd", "wb").write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\n\n" + bytes(
    1 + x // 4 + 2 * (y // 4) for z in range(8) for y in range(8) for x in range(8)))'
printf '1,Rest,0,255,0\n2,all,0,0,255\n3,c,255,0,0\n4,d,255,255,0\n' >table.csv
shown() { halflight render map.nrrd --label-table table.csv --show "$1" --print-scene >scene.json
  tool json scene.json "[(l['name'], round(l.get('opacity', 1), 6)) for l in d['volumes'][0]['labels'] if l.get('visible', True)]"; }
shown rest,c:0.5
shown all:0,2
shown 1,2:0.5
# With a mask "rest" is what lies beside it, and the label of this name stays hidden.
halflight render map.nrrd --mask map.nrrd --label-table table.csv --show c,rest:0.5 --print-scene >scene.json
tool json scene.json "[l['name'] for l in d['volumes'][0]['mask']['labels']]"
