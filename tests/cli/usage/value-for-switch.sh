halflight render --quiet=yes x.nrrd
