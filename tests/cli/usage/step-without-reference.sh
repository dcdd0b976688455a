halflight render x.nrrd --step 0.5
