halflight render x.nrrd -o nowhere/x.png
