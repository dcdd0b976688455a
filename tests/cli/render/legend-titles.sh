# Of several volumes, the legend calls a volume without a name by its file; a volume that is alone has no title.
# slow: 6 seconds of processor time
tool ball 16 ball_16x16x16_uint8.raw
tool ball 16 other_16x16x16_uint8.raw
halflight convert ball_16x16x16_uint8.raw map.nrrd --quiet
draw() {
  name=$1
  shift
  halflight render ${name}_16x16x16_uint8.raw --threshold 90 --legend auto --size 120x120 --quiet "$@"
}
draw ball -o alone-a.png
draw other -o alone-b.png
halflight diff --max-error 0 alone-a.png alone-b.png >/dev/null
draw ball --labels map.nrrd -o two-a.png
draw other --labels map.nrrd -o two-b.png
halflight diff --max-error 0 two-a.png two-b.png >/dev/null 2>&1 || echo "titles differ"
