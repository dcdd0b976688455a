halflight render --size 512 x.nrrd
