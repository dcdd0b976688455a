halflight render --size 5.5x5 x.nrrd
