halflight render --sizee 3x3 x.nrrd
