halflight render nowhere.nrrd
