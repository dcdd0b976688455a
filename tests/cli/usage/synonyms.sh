# Words of other programs lead to the option that does the same; the nearest word is told beside it.
for word in anatomical-space panel-label bounding-box rotate pitch resize samples isovalue bg cmap resolution clim crop dump fov spp voxel-size field band light-dir slices hdri colorbar measure; do
  halflight render --$word 1 x.nrrd 2>>told || true
done
sed 's/.*unknown option //' told
# Of the subcommand's own options only.
halflight diff --threshold 1 a.png b.png 2>told || true
cat told
# An option's value stands in the answer where the word means one.
halflight animate x.nrrd --light-sweep 2>told || true
halflight convert x.nrrd y.nrrd --scale 0.5 2>>told || true
cat told
# Words for which there is no option are answered, also for films and as one letter.
for word in dtype overwrite hdr percentile log cbar alpha flip 4k; do
  halflight render x.nrrd --$word 2>>answers || true
done
halflight render x.nrrd -j 2 2>>answers || true
for word in easing duration keyframes codec orbit; do
  halflight animate x.nrrd --$word 2>>answers || true
done
halflight colormaps 2>>answers || true
halflight mesh x.nrrd 2>>answers || true
sed 's/.*unknown //' answers
