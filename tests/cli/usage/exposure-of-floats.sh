halflight render x.nrrd -o x.exr --exposure 1
