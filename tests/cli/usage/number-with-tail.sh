halflight render --zoom 2px x.nrrd
