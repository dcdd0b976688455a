halflight render x.nrrd -o x.jpg
