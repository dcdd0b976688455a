# A map of one label without a name has the name of its file, as a mask over a scan has; of several labels none has it.
tool ball 24 scan_24x24x24_uint8.raw
"$PYTHON" -c "
import numpy
labels = numpy.zeros((24, 24, 24), numpy.uint8)
labels[2:6, 2:6, 2:6] = 1
labels.tofile('24x24x24_uint8.raw')
labels[12:16, 2:6, 2:6] = 2
labels.tofile('two_24x24x24_uint8.raw')"
halflight convert 24x24x24_uint8.raw lesion.nii.gz --quiet
for option in labels mask; do
  halflight render scan_24x24x24_uint8.raw --$option lesion.nii.gz --show Lesion=red --print-scene >scene.json
  tool json scene.json "sorted({(label.get('name'), label['value']) for v in d['volumes'] for part in (v, v.get('mask', {})) for label in part.get('labels', [])})"
done
halflight render lesion.nii.gz --show lesion --quiet --print-scene >scene.json
tool json scene.json "[(label.get('name'), label['value']) for label in d['volumes'][0]['labels']]"
halflight render scan_24x24x24_uint8.raw --labels two_24x24x24_uint8.raw --print-scene >scene.json
tool json scene.json "[(label.get('name'), label['value']) for label in d['volumes'][1]['labels']]"
printf '1 tumour 255 0 0 0\n' >table.txt
halflight render scan_24x24x24_uint8.raw --labels lesion.nii.gz --label-table table.txt --print-scene >scene.json
tool json scene.json "[(label.get('name'), label['value']) for label in d['volumes'][1]['labels']]"
