# Ctrl-C keeps the pictures that are whole; the same command goes on.
halflight make rings --size 48 --quiet
halflight render rings.nrrd --size 400x400 --print-scene >scene.json
"$HALFLIGHT" animate scene.json --turntable 4000 -o turn 2>said &
await_handler $!
kill -INT $!
code=0
wait $! || code=$?
echo $code
cat said
ls turn | grep -v -c png || true
