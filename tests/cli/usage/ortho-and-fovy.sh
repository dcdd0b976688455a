halflight render --ortho --fovy 30 x.nrrd
