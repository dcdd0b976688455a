# Shapes are solid matter, though thin rings have few voxels that no rim reaches.
for shape in sphere torus rings; do
  halflight make $shape --quiet
  halflight info $shape.nrrd | grep -o 'taken for   [a-z ]*'
done
