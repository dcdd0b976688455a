halflight render --layers x.nrrd
