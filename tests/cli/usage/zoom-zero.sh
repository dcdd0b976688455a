halflight render --zoom 0 x.nrrd
