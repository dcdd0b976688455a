# A panel's reference that takes long says how long, and what makes it faster.
# slow: rays of a sanitized program need minutes until the time that is left is known
tool ball 24 ball_24x24x24_uint8.raw
echo '{ "width": "50cm", "panels": [ { "input": "ball_24x24x24_uint8.raw", "reference": true } ] }' >figure.json
"$HALFLIGHT" figure figure.json -o x.png 2>said.txt &
for _ in $(seq 3000); do
  if grep -qs ' left: ' said.txt; then break; fi
  sleep 0.1
done
kill -INT $!
wait $! || true
grep -c '^figure.json: about [1-9][0-9]* [a-z0-9 ]* left: "reference" marches every ray: a smaller "dpi", fewer "light-points" or a greater "step" is faster$' said.txt
