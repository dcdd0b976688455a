halflight info --size 3x3 x.nrrd
