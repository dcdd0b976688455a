# A legend without room for all its rows stands in a strip below the picture, where it has them all, and a line says so. One
# that would cover what the picture shows does, too: the picture above the strip is then the picture without a legend.
tool atlas 16 map.nrrd
legend() { halflight render map.nrrd --legend --size "$@" -o legend.png 2>&1 | sed 's/^legend.png: .*/no word/' | head -n 1; }
legend 120x60
legend 120x60 --place legend=below
legend 160x60
legend 400x160 --zoom 0.3
legend 200x200 --zoom 1.2
halflight render map.nrrd --size 200x200 --zoom 1.2 --quiet -o plain.png
for at in 20,20 100,100 180,30 60,190; do
  test "$(tool png-pixel plain.png ${at%,*} ${at#*,})" = "$(tool png-pixel legend.png ${at%,*} ${at#*,})" && echo same
done
