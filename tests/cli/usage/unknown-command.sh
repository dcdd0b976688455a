halflight rendr x.nrrd
