halflight render --size 512x x.nrrd
