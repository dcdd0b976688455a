halflight make furry-spere
