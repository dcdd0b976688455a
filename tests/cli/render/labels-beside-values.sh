# Options of values without a name are for the volumes of values, and leave the label map beside them out.
tool ball 24 scan_24x24x24_uint8.raw
tool atlas 24 map.nrrd
halflight render scan_24x24x24_uint8.raw --iso 90:silver:0.25 --labels map.nrrd --print-scene >iso.json
tool json iso.json "[(len(v.get('iso', [])), len(v.get('labels', []))) for v in d['volumes']]"
halflight render scan_24x24x24_uint8.raw --labels map.nrrd --print-scene >plain.json
halflight render scan_24x24x24_uint8.raw --threshold 90 --colormap hot --labels map.nrrd --print-scene >hot.json
for scene in plain hot; do tool json $scene.json "d['volumes'][1]"; done | uniq | wc -l
halflight render scan_24x24x24_uint8.raw --iso map=1 --labels map.nrrd --print-scene 2>message || cut -d: -f3- message | tail -1
