# Files of one picture may tell different units of length: those of the later files are converted to the first one's.
# Each picture of a part in millimetres is compared with the one of the same part in micrometres.
# slow: 4 seconds of processor time
tool ball 16 ball_16x16x16_uint8.raw
halflight convert ball_16x16x16_uint8.raw scan.nrrd --spacing 0.25 --unit mm --quiet
for unit in mm um; do
  mkdir $unit
  cp ball_16x16x16_uint8.raw $unit/
  halflight convert ball_16x16x16_uint8.raw $unit/part.nrrd --spacing $(test $unit = mm && echo 0.125 || echo 125) --unit $unit --quiet
  "$PYTHON" -c 'import sys; data = open(sys.argv[1], "rb").read(); open(sys.argv[2], "wb").write(bytes(255 * (b > 127) // 85 for b in data))' \
    ball_16x16x16_uint8.raw $unit/map_16x16x16_uint8.raw
  halflight convert $unit/map_16x16x16_uint8.raw $unit/map.nrrd --spacing $(test $unit = mm && echo 0.25 || echo 250) --unit $unit --quiet
done
same() { # same ARGUMENTS, with @ for the folder
  for unit in mm um; do
    halflight render $(echo "$*" | sed "s/@/$unit/") --size 48x40 -o $unit.png 2>$unit.log
    grep 'warning' $unit.log || true
  done
  halflight diff --max-error 0.002 mm.png um.png >/dev/null && echo "$*"
  # The picture's own scene places the files in the same way.
  halflight render um.png --quiet -o again.png
  cmp um.png again.png
}
same scan.nrrd @/part.nrrd
same scan.nrrd @/part.nrrd --threshold part=128
same scan.nrrd @/part.nrrd --tf part=ct-bone
same scan.nrrd @/part.nrrd --slice z=0.3
same scan.nrrd --iso 100:silver:0.25 --labels @/map.nrrd --show all=red
same scan.nrrd --mask @/map.nrrd
same scan.nrrd --color-by @/part.nrrd
# The bar has the first file's unit.
for unit in mm um; do
  halflight render scan.nrrd $unit/part.nrrd --ortho --scale-bar auto --size 48x40 --quiet -o bar-$unit.png
done
halflight diff --max-error 0.002 bar-mm.png bar-um.png >/dev/null && echo "scale bar"
halflight render um/part.nrrd scan.nrrd --print-scene >scene.json
tool json scene.json '[v.get("transform", {}).get("scale", 1) for v in d["volumes"]]'
# Where a scene does not convert them, the bar names both units, and the scale that would.
sed 's/"scale": 1000/"scale": 1/' scene.json >unlike.json
! halflight render unlike.json --ortho --scale-bar auto --size 16 -o none.png
