halflight render --zoom 1 --zoom 2 x.nrrd
