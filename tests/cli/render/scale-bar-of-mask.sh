# The unit that one file tells holds for files that tell none, as masks do; without any, the bar is refused. The lengths of a
# further file are converted to the first one's unit.
tool ball 16 mask_16x16x16_uint8.raw
scan() { # scan UNIT SPACING
  printf 'NRRD0005\ntype: uint8\ndimension: 3\nspace dimension: 3\nsizes: 16 16 16\nspace directions: (%s,0,0) (0,%s,0) (0,0,%s)\n' $2 $2 $2
  printf 'space units: "%s" "%s" "%s"\nencoding: raw\n\n' "$1" "$1" "$1"
  cat mask_16x16x16_uint8.raw
}
scan mm 1 >scan.nrrd
halflight render scan.nrrd --size 64x64 --ortho --scale-bar auto --quiet -o alone.png || { echo "this build draws nothing"; exit 77; }
for inputs in 'scan.nrrd mask_16x16x16_uint8.raw' 'mask_16x16x16_uint8.raw scan.nrrd'; do
  halflight render $inputs --size 64x64 --ortho --scale-bar auto --quiet -o both.png
  halflight render $inputs --size 64x64 --ortho --scale-bar auto --unit mm --quiet -o stated.png
  halflight diff --max-error 0 both.png stated.png >difference
done
! halflight render mask_16x16x16_uint8.raw --size 64x64 --ortho --scale-bar auto -o none.png 2>error
cat error
scan um 1000 >other.nrrd
halflight render scan.nrrd scan.nrrd --size 64x64 --ortho --scale-bar auto --quiet -o both.png
halflight render scan.nrrd other.nrrd --size 64x64 --ortho --scale-bar auto --quiet -o converted.png
halflight diff --max-error 0.002 both.png converted.png >difference
