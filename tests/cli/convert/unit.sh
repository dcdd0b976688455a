# --unit says the unit where the file does not tell it. Formats that know only some units get the lengths in one of those.
tool ball 8 ball_8x8x8_uint8.raw
told() { halflight info $1 --json | "$PYTHON" -c 'import json, sys; told = json.load(sys.stdin); print(told["unit"], round(told["spacing"][0], 9))'; }
for unit in um µm mm angstrom nm cm; do
  halflight convert ball_8x8x8_uint8.raw a.nrrd --spacing 0.5 --unit $unit --quiet
  told a.nrrd
done
halflight convert ball_8x8x8_uint8.raw a.nii --spacing 0.5 --unit m --quiet
told a.nii
halflight render a.nii --scale-bar auto --ortho --size 64 --quiet -o bar.png
halflight convert ball_8x8x8_uint8.raw a.mha --unit um 2>&1 | grep unit
# A unit that the file tells is not changed.
halflight convert a.nii b.nrrd --unit metre --quiet
told b.nrrd
for unit in um parsec; do halflight convert a.nii b.nrrd --unit $unit --quiet 2>&1 || echo $?; done
halflight convert ball_8x8x8_uint8.raw b.nrrd --unit furlong --quiet 2>&1 || echo $?
# NIfTI always states directions of a body: where the source has none, a line says so.
halflight convert ball_8x8x8_uint8.raw a.nii 2>&1 | grep -c 'tells no directions'
halflight convert a.nii b.nii.gz 2>&1 | grep -c 'tells no directions' || true
