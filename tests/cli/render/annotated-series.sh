# The texts of a series have each picture's number and the name of its file, and those of a film its frame.
halflight make torus --size 16 --quiet -o a-07.nrrd
cp a-07.nrrd a-08.nrrd
series() { halflight render 'a-*.nrrd' --size 120x60 --quiet --annotate "$1@0.1,0.5" -o "$2"; }
series 't = %d, 50 %: %s %03d %' asked-%d.png
series 't = 0, 50 %: a-07 000 %' first-%d.png
series 't = 1, 50 %: a-08 001 %' second-%d.png
for pair in 'asked-0 first-0' 'asked-1 second-1' 'asked-1 first-1'; do
  set -- $pair
  halflight diff $1.png $2.png | grep -c 'pixels  *0 of' || true
done
halflight animate a-07.nrrd --turntable 2 --size 60 --quiet --annotate '%d@0.5,0.5' -o film
halflight animate a-07.nrrd --turntable 2 --size 60 --quiet --annotate '1@0.5,0.5' -o ones
for frame in 0 1; do halflight diff film/*$frame.png ones/*$frame.png | grep -c 'pixels  *0 of' || true; done
