# Formats that are read slice by slice or chunk by chunk give the same voxels where memory has no room for all of them.
size=160x170x200
mkdir scratch
export TMPDIR=$PWD/scratch
tool stack $size whole_${size}_uint8.raw
for volume in whole_${size}_uint8.raw a.tif a.zarr a.dicom a.slices; do
  test -e $volume || tool stack $size $volume
  halflight convert $volume copy_${size}_uint8.raw --max-memory 5M --quiet
  cmp whole_${size}_uint8.raw copy_${size}_uint8.raw && echo "$volume: the same"
done
halflight convert whole_${size}_uint8.raw a.nii.gz --quiet
halflight convert a.nii.gz copy_${size}_uint8.raw --max-memory 5M --quiet
cmp whole_${size}_uint8.raw copy_${size}_uint8.raw && echo "a.nii.gz: the same"
ls scratch
