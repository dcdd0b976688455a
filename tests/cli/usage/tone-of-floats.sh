halflight render x.nrrd -o x.npy --tone filmic
