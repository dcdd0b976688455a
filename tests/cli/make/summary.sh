halflight make torus --size 32
