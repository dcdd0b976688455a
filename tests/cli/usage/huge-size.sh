halflight render --size 99999x1 x.nrrd
