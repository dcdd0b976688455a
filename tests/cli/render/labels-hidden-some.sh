# Labels that other matter encloses are told of by name, also where other labels of the map are seen; the most opaque ones come first. Labels
# at the far side, labels within other labels, and labels outside of all matter are not told of.
tool ball 24 scan_24x24x24_uint8.raw
"$PYTHON" -c "
import numpy
labels = numpy.zeros((24, 24, 24), numpy.uint8)
for value, place in ((1, 12), (2, 3), (3, 9)):
    labels[10:14, place - 1:place + 2, 10:14] = value
labels[1:6, 1:6, 1:6] = 4
labels[3, 3, 3] = 5
labels.tofile('map_24x24x24_uint8.raw')"
printf '1,core,255,0,0\n3,second core,0,255,0\n' >table.csv
told() {
  echo "$*: $(halflight render scan_24x24x24_uint8.raw --labels map_24x24x24_uint8.raw "$@" --print-scene 2>&1 >scene.json | cut -d: -f1)"
}
told --view front
told --view back
told --view front --label-table table.csv
told --view front --label-table table.csv --show 'core:0.5,second core,2'
told --view front --show 1,3
told --view front --show 2,4
told --view front --show 1,2 --cut-box 'scan_24x24x24_uint8=y=:0.5'
