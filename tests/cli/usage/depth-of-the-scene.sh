halflight render none.nrrd --depth -o d.exr
