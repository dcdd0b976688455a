mkdir x.png
halflight render x.nrrd -o x.png
