halflight render x.nrrd --light 0,91
