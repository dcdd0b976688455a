halflight render x.nrrd --size
