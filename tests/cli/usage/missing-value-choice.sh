halflight render x.nrrd --kernel
