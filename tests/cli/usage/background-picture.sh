halflight render x.nrrd --background plate.png
