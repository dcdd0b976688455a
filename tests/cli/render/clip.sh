# Fractions of the box around the cells, from -0.5 to 15.5; coordinates in the file's unit; ends that are left out.
tool ball 16 ball_16x16x16_uint8.raw
clip() { halflight render ball_16x16x16_uint8.raw --print-scene "$@" >scene.json; tool json scene.json "d['volumes'][0]['clip']"; }
clip --clip x=0:0.5
clip --clip y=0.25: --clip z=2mm:9.5u
clip --clip x=:7u
halflight render ball_16x16x16_uint8.raw --quiet --size 32x32 --clip x=0:0.5 -o half.npy
halflight render ball_16x16x16_uint8.raw --quiet --size 32x32 -o whole.npy
if cmp -s half.npy whole.npy; then echo "nothing was cut"; fi
# A unit is converted to the file's own: a file in micrometres.
{ printf 'NRRD0004\ntype: uint8\ndimension: 3\nspace dimension: 3\nsizes: 16 16 16\nspace units: "um" "um" "um"\nspace directions: (5,0,0) (0,5,0) (0,0,5)\nspace origin: (0,0,0)\nencoding: raw\n\n'; cat ball_16x16x16_uint8.raw; } >micro.nrrd
halflight render micro.nrrd --print-scene --clip x=10um:0.05mm --clip y=:0.04mm >scene.json
tool json scene.json "d['volumes'][0]['clip']"
halflight render micro.nrrd --print-scene --cut-sphere 0.02mm,20um,20u:0.01mm >scene.json
tool json scene.json "d['volumes'][0]['cuts'][0]"
