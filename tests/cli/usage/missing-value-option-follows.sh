halflight render x.nrrd --output --json
