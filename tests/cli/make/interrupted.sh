# An interrupted run leaves no file and the old one in place.
echo old >fire-ball.nrrd
"$HALFLIGHT" make fire-ball --size 512 --quiet 2>/dev/null &
await_handler $!
kill -INT $!
code=0
wait $! || code=$?
echo $code
echo *
cat fire-ball.nrrd
