mkdir folder.nrrd
halflight info folder.nrrd
