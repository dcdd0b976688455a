# NAME= cuts one volume alone, in its own world, and other cuts the whole scene. A file's name is the part before its extensions.
tool ball 16 ball_16x16x16_uint8.raw
halflight convert ball_16x16x16_uint8.raw head.nii.gz --quiet
cp ball_16x16x16_uint8.raw brain_16x16x16_uint8.raw
halflight render head.nii.gz brain_16x16x16_uint8.raw --cut-box head=x=0.5: --cut-plane z=0.5 --cut-sphere head=0.5,0.5,1:0.2 --print-scene >a.json
tool json a.json "[[c['type'] for c in part.get('cuts', [])] for part in (d, *d['volumes'])]"
tool json a.json "d['volumes'][0]['cuts'][0]['min'][0]"
halflight render head.nii.gz brain_16x16x16_uint8.raw --clip brain_16x16x16_uint8=y=0.25: --print-scene >a.json
tool json a.json "[volume.get('clip', {}).get('min') for volume in d['volumes']]"
# Of one volume, its name may be left out.
halflight render head.nii.gz --cut-plane head=x=0.5 --print-scene >a.json
halflight render head.nii.gz --cut-plane x=0.5 --print-scene >b.json
cmp a.json b.json
# A label map beside the volume stays whole, and has a name of its own.
halflight convert head.nii.gz labels.nii.gz --type uint8 --quiet
halflight render head.nii.gz --labels labels.nii.gz --cut-box head=x=0.5: --print-scene >a.json
tool json a.json "[len(volume.get('cuts', [])) for volume in d['volumes']]"
! halflight render head.nii.gz --labels labels.nii.gz --cut-box heads=x=0.5: -o a.png 2>error
cat error
