halflight render --azimuth nan x.nrrd
