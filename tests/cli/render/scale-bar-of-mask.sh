# The unit that one file tells holds for files that tell none, as masks do; without any, the bar is refused.
tool ball 16 mask_16x16x16_uint8.raw
scan() { # scan UNIT
  printf 'NRRD0005\ntype: uint8\ndimension: 3\nspace dimension: 3\nsizes: 16 16 16\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n'
  printf 'space units: "%s" "%s" "%s"\nencoding: raw\n\n' "$1" "$1" "$1"
  cat mask_16x16x16_uint8.raw
}
scan mm >scan.nrrd
halflight render scan.nrrd --size 64x64 --ortho --scale-bar auto --quiet -o alone.png || { echo "this build draws nothing"; exit 77; }
for inputs in 'scan.nrrd mask_16x16x16_uint8.raw' 'mask_16x16x16_uint8.raw scan.nrrd'; do
  halflight render $inputs --size 64x64 --ortho --scale-bar auto --quiet -o both.png
  halflight render $inputs --size 64x64 --ortho --scale-bar auto --unit mm --quiet -o stated.png
  halflight diff --max-error 0 both.png stated.png >difference
done
! halflight render mask_16x16x16_uint8.raw --size 64x64 --ortho --scale-bar auto -o none.png 2>error
cat error
scan um >other.nrrd
! halflight render scan.nrrd other.nrrd --size 64x64 --ortho --scale-bar auto -o none.png 2>error
cat error
