halflight make
