# A legend without room for all its rows leads on to the strip below the picture, where it has them all; one with room says nothing.
tool atlas 16 map.nrrd
legend() { halflight render map.nrrd --legend --size "$@" -o legend.png 2>&1 | sed 's/^legend.png: .*/no word/' | head -n 1; }
legend 120x60
legend 120x60 --place legend=below
legend 160x60
