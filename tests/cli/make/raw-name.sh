halflight make torus --size 32 -o ring.raw
