halflight make rings -o rings.nrrd
