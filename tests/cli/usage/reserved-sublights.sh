halflight render --soft-method sublights x.nrrd
