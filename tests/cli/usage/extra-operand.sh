halflight render a.nrrd b.nrrd
