# A panel may be a picture of the reference: an .exr or .npy that was rendered before, or "reference" in the panel.
halflight make torus --size 16 --quiet
options="--ortho --view front --shadows hard --sky 0 --background #336699 --size 40x40 --quiet"
halflight render torus.nrrd $options --reference -o exact.npy
halflight render torus.nrrd $options --reference -o exact.exr
halflight render torus.nrrd $options --reference -o exact.png
# A picture without a scene lies over the page's background where it lets light through.
figure() { echo "{ \"width\": \"10.16mm\", \"dpi\": 100, \"background\": \"#336699\", \"panels\": [ $1 ] }" >figure.json; }
compare() {
  for place in "1 1" "20 20" "10 18"; do
    shown=$(tool png-pixel page.png $place)
    exact=$(tool png-pixel exact.png $place)
    test "$shown" = "$exact" || echo "$1: $place: $shown, exact $exact"
  done
}
for file in exact.npy exact.exr; do
  figure "{ \"input\": \"$file\" }"
  halflight figure figure.json --quiet -o page.png
  compare $file
done
figure '{ "input": "torus.nrrd", "aspect": 1, "ortho": true, "view": "front", "shadows": "hard", "sky": 0,
          "background": "#336699", "reference": true }'
halflight figure figure.json --quiet -o page.png
compare reference
# The summary names the file as the command line does.
mkdir pages
halflight figure figure.json -o pages/page.png 2>&1 | sed 's/, [0-9.e-]* s$//'
