halflight render --light-samples 3 x.nrrd
