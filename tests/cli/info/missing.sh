halflight info nowhere.nrrd
