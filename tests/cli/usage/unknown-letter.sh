halflight render -x x.nrrd
