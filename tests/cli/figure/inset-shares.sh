# An inset shares all that its panel shares but the camera: sharing a camera that the panels have in any case changes nothing.
halflight make rings --size 24 --quiet
figure() { # figure SHARED NAME
  echo "{ \"width\": \"40mm\", \"dpi\": 60, \"letters\": false, \"share\": [$1], \"options\": { \"background\": \"white\" }, \"panels\": [
    { \"input\": \"rings.nrrd\" }, { \"input\": \"rings.nrrd\", \"look\": \"translucent\", \"inset\": { \"zoom\": 3 } } ] }" >figure.json
  halflight figure figure.json --quiet -o $2.png
}
figure '"light", "range"' without
figure '"camera", "light", "range"' with
halflight diff --max-error 0 without.png with.png >/dev/null && echo same
figure '"camera", "light"' own
cmp -s with.png own.png || echo "the function is shared"
