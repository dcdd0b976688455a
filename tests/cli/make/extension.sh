halflight make torus -o ring.png
