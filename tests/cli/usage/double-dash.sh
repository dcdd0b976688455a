halflight render -- -x.nrrd
