halflight make --list torus
