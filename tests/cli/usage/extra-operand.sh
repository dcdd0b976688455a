halflight info a.nrrd b.nrrd
