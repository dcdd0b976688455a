halflight bench missing.nrrd
