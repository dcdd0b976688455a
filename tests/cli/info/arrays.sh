# Arrays and components, as text and as JSON.
cat >a.vti <<'END'
<VTKFile type="ImageData"><ImageData WholeExtent="0 1 0 1 0 1"><CellData><DataArray type="Int16" Name="c">1</DataArray></CellData>
<PointData Vectors="v"><DataArray type="UInt8" Name="p">0 2 3 4 5 6 7 200</DataArray>
<DataArray type="Float32" Name="v" NumberOfComponents="3">3 4 0 0 0 1 0 0 2 0 0 3 0 0 4 0 0 5 0 0 6 2 3 6</DataArray>
</PointData></ImageData></VTKFile>
END
halflight info a.vti 2>message | grep -A2 arrays
halflight info a.vti --array v 2>message | grep -A2 arrays
halflight info a.vti --array v --component magnitude --json >info.json
tool json info.json "[[a[key] for key in ('name', 'type', 'components', 'of_cells', 'chosen')] for a in d['arrays']]"
tool json info.json "d['components'], d['component'], d['type'], d['range']"
# A series: its time steps.
printf 'NDims = 4\nDimSize = 2 1 1 3\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n123456' >s.mha
halflight info s.mha --time 2 | grep -A1 times
halflight info s.mha --time 1 --json >info.json
tool json info.json "[d[key] for key in ('times', 'time', 'channels', 'channel', 'levels', 'level', 'range')]"
