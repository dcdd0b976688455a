halflight render x.nrrd --print-scene -o a.png
