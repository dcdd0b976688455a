# Every example of the figures is read and rendered, with what stands in for the data that the project does not have.
# slow: it renders every example
for scene in "$SOURCE"/examples/fig*.json; do
  halflight render "$scene" --data nowhere --size 16x16 --sheet-spacing 8 --quiet -o picture.npy
  [ "$(tool npy-shape picture.npy)" = "16 16 4" ]
  grep -q '"description": "' "$scene"
done
