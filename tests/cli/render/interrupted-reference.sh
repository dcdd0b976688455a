tool ball 24 ball_24x24x24_uint8.raw
"$HALFLIGHT" render ball_24x24x24_uint8.raw --reference --size 2048x2048 --quiet -o x.png 2>/dev/null &
await_handler $!
kill -INT $!
code=0
wait $! || code=$?
echo $code
echo *
