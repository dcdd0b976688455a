echo 'no volume at all' >garbage.nrrd
halflight info garbage.nrrd
