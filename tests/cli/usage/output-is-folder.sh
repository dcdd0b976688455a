mkdir x.nrrd
halflight make ball --size 16 -o x.nrrd
