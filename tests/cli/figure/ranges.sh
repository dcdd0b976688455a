# A panel's "range" is a text, a list of numbers, or a list of texts for several volumes.
tool ball 16 a_16x16x16_uint8.raw
for range in '[180, 220]' '["a=180,220"]' '"180,220"' null; do
  echo "{\"width\": \"20mm\", \"dpi\": 20, \"letters\": false, \"panels\": [{\"input\": \"a_16x16x16_uint8.raw\", \"range\": $range}]}" >figure.json
  halflight figure figure.json --quiet -o figure.tif || { echo "this build draws nothing"; exit 77; }
  cksum <figure.tif >>sums
done
echo "pictures: $(uniq -c sums | awk '{ print $1 }' | tr '\n' ' ')"
