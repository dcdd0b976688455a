halflight render --background 1,2 x.nrrd
