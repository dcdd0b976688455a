halflight render --max-memory 12Q x.nrrd
