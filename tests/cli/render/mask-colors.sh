# Matter within a mask keeps its colours, and a line says how the colours of the labels' file come in: by "=own". Nothing is said where no file
# gives a colour, or where one is asked for. Labels that are no mask have their own colours anyway.
"$PYTHON" -c 'open("map.nrrd", "wb").write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\n\n" + bytes(
    1 + x // 4 for z in range(8) for y in range(8) for x in range(8)))'
tool ball 8 ball_8x8x8_uint8.raw
printf '1,left,255,0,0\n2,right,0,255,0\n' >table.csv
shown() {
  halflight render ball_8x8x8_uint8.raw "$@" --print-scene 2>message >scene.json
  cut -c1-120 message
  tool json scene.json "[(l['value'], l['color'] if l.get('tint') else 'kept') for l in d['volumes'][0]['mask']['labels']]"
}
shown --mask map.nrrd --label-table table.csv
shown --mask map.nrrd --label-table table.csv --show rest,right
shown --mask map.nrrd --label-table table.csv --show all=own
shown --mask map.nrrd --label-table table.csv --show right=OWN,left=blue
shown --mask map.nrrd
shown --mask map.nrrd --show 1=own | sed 's/\[[0-9.]*, [0-9.]*, [0-9.]*\]/a colour/'
halflight render map.nrrd --label-table table.csv --show left=own --print-scene 2>/dev/null >scene.json
tool json scene.json "d['volumes'][0]['labels'][0]['color']"
