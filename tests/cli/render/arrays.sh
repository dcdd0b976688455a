# What is taken of several arrays or components is told; what is named is not; the scene keeps it.
cat >a.vti <<'END'
<VTKFile type="ImageData"><ImageData WholeExtent="0 1 0 1 0 1"><PointData>
<DataArray type="UInt8" Name="p">0 2 3 4 5 6 7 200</DataArray><DataArray type="UInt8" Name="q">8 7 6 5 4 3 2 1</DataArray>
<DataArray type="Float32" Name="v" NumberOfComponents="3">3 4 0 0 0 1 0 0 2 0 0 3 0 0 4 0 0 5 0 0 6 2 3 6</DataArray>
</PointData></ImageData></VTKFile>
END
set -- --size 8x8 --quiet
halflight render a.vti --size 8x8 -o p.npy 2>message
sed -n 1p message
halflight render a.vti "$@" --array v --component magnitude -o v.npy
halflight render a.vti --array v --component magnitude --spacing 1,2,3 --print-scene >scene.json
tool json scene.json "[d['volumes'][0][key] for key in ('array', 'component', 'spacing')]"
halflight render a.vti "$@" --array v --component magnitude --spacing 1,2,3 -o s.npy
halflight render scene.json "$@" -o t.npy
cmp s.npy t.npy
# One file twice in a scene, each time another array.
echo '{"halflight": 1, "volumes": [{"file": "a.vti", "array": "p"}, {"file": "a.vti", "array": "v", "component": 2}]}' >two.json
halflight render two.json --print-scene >again.json
tool json again.json "[v['array'] for v in d['volumes']], d['volumes'][1]['component'], d['volumes'][0]['transfer_function'] != d['volumes'][1]['transfer_function']"
for options in "--array w" "--array v --component 3" "--array p --component magnitude" "--component -1" "--spacing 1,0,1"; do
  code=0
  halflight render a.vti $options 2>message || code=$?
  echo $code $(cat message)
done
code=0
halflight render two.json --array p 2>message || code=$?
echo $code $(cat message)
