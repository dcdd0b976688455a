halflight render x.nrrd --shaodws=hard
