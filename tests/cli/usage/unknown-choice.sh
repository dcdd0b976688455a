halflight render --shadows sofft x.nrrd
