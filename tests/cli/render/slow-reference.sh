# A reference that takes long says how long, and what makes it faster, also where no terminal shows a bar.
# slow: 12 seconds of processor time
tool ball 24 ball_24x24x24_uint8.raw
"$HALFLIGHT" render ball_24x24x24_uint8.raw --reference --size 2048x2048 -o x.png 2>said.txt &
for _ in $(seq 3000); do
  if grep -qs ' left: ' said.txt; then break; fi
  sleep 0.1
done
kill -INT $!
wait $! || true
grep -c '^ball_24x24x24_uint8.raw: about [1-9][0-9]* \(min\|h\) [0-9]* \(s\|min\) left: --reference marches every ray: a smaller --size, fewer --light-points or a greater --step is faster$' said.txt
