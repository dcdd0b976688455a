# What a mesh file holds, as text and as JSON.
printf 'v 0 0 0 1 0 0\nv 2 0 0 1 0 0\nv 2 3 0 1 0 0\nv 0 3 1 1 0 0\nf 1 2 3 4\n' >a.obj
halflight info a.obj
halflight info a.obj --json
halflight info a.obj --time 1
