# A PLY file without faces is a cloud of points: spheres of a 400th of the diagonal, in the points' colours.
printf 'ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n0 0 0 255 0 0\n0 0 400 0 255 0\n' >points.ply
halflight info points.ply
halflight info points.ply --json >points.json
tool json points.json 'd["spheres"], d["colors"], d["triangles"]'
