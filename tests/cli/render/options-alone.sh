# A legend, a scale bar and axes without a value are drawn by their usual choice.
halflight make torus --size 16 -o torus.nrrd >/dev/null 2>&1
set -- render torus.nrrd --ortho --unit mm --size 160 --no-metadata --threads 1
halflight "$@" --legend auto --axes arrows --scale-bar auto -o said.png >/dev/null 2>&1
halflight "$@" -o alone.png --legend --axes --scale-bar >/dev/null 2>&1
cmp said.png alone.png && echo same
