# A cloud is taken for one on coarse and on fine grids, whose neighbouring voxels differ less.
for size in 64 128 200; do
  halflight make cloud --size $size --quiet
  halflight info cloud.nrrd | grep -o 'taken for   [a-z ]*'
done
