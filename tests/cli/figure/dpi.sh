# --dpi takes the place of the page's own "dpi"; the page stays as wide.
halflight make rings --size 24 --quiet
echo '{ "width": "40mm", "dpi": 150, "panels": [ { "input": "rings.nrrd", "aspect": 2 } ] }' >figure.json
for options in '' '--dpi 50'; do
  halflight figure figure.json $options --quiet -o page.png
  halflight info page.png | sed -n 's/,.*//; s/^  picture *//p'
done
halflight figure figure.json --dpi 9 -o page.png 2>&1 || echo $?
