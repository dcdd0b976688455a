halflight render --max-memory 99999999999G x.nrrd
