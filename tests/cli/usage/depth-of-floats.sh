halflight render x.nrrd -o x.npy --depth 16
