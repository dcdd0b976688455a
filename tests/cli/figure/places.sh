# What is drawn over a picture keeps clear of other drawings.
# slow: 6 seconds of processor time
halflight make rings --size 24 --quiet
halflight convert rings.nrrd body.nii --quiet
draw() { halflight render "$@" --size 200x200 --quiet; }
# The text of a ruler keeps clear of the legend, into which it would run from the middle of the line.
draw rings.nrrd --ortho --view front --zoom 0.4 --look surface --print-scene >plain.json
sed '$d' plain.json >scene.json
cat >>scene.json <<'END'
, "marks": [ { "kind": "ruler", "points": [[-1, 0, 0.6], [1.2, 0, 1.4]], "text": "from side to side" } ] }
END
draw scene.json -o plain.png
draw scene.json --legend auto -o legend.png
draw scene.json --legend auto --marks -o both.png
tool drawn-over plain.png legend.png both.png | awk '{ print ($1 > 0), ($2 > 0), $3 }'
# The body's letters keep clear of a text in the middle of the upper edge.
draw body.nii --view front --annotate 'seen from the front@0.3,0.06' -o text.png
draw body.nii --view front -o bare.png
draw body.nii --view front --annotate 'seen from the front@0.3,0.06' --axes letters -o both.png
tool drawn-over bare.png text.png both.png | awk '{ print ($1 > 0), ($2 > 0), $3 }'
# Arrows, a legend, a scale bar and a panel's letter are seen whole beside an inset in their corner: they change as many
# pixels, to a tenth, as without the inset.
panel() {
  echo "{ \"width\": \"40mm\", \"dpi\": 150, \"font-size\": 5, \"letters\": false, \"panels\": [
    { \"input\": \"rings.nrrd\", \"ortho\": true, \"zoom\": 0.05, $1 } ] }" >figure.json
  halflight figure figure.json --quiet -o $2.png
}
changed() {
  panel "$2" without
  panel "$2, $1" with
  tool drawn-over without.png with.png with.png | cut -d' ' -f1
}
beside() {
  free=$(changed "$2" '"look": "surface"')
  changed "$2" "\"look\": \"surface\", \"inset\": { \"corner\": \"$1\", \"part\": 0.5 }" |
    awk -v free=$free '{ print (free > 20 && $1 > 0.9 * free && $1 < 1.1 * free) ? "whole" : $1 " of " free }'
}
beside 'lower right' '"axes": "arrows"'
beside 'upper right' '"legend": "auto"'
beside 'lower left' '"scale-bar": "auto", "unit": "mm"'
beside 'upper left' '"letter": "a"'
# A text without a place keeps clear of the panel's letter, and of another such text.
panel '"letter": ""' plain
panel '"letter": "a"' letter
panel '"letter": "a", "annotate": "first"' both
tool drawn-over plain.png letter.png both.png | awk '{ print ($1 > 0), ($2 > 0), $3 }'
panel '"letter": "a", "annotate": ["first", "second"]' three
tool drawn-over plain.png both.png three.png | awk '{ print ($1 > 0), ($2 > 0), $3 }'
