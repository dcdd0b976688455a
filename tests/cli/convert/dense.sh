# Cells of a mesh lie in bricks at levels. A file with voxels gets all of them, which the program says, and without bricks says not.
halflight convert "$SOURCE/tests/fuzz/corpus/vtu/hexahedra.vtu" dense.nrrd 2>&1 | grep evaluated
halflight convert dense.nrrd again.nrrd 2>&1 | grep -c evaluated || true
