halflight view x.nrrd
