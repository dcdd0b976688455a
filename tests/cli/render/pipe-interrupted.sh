# A pipe that nobody fills is given up.
mkfifo pipe
"$HALFLIGHT" render pipe -o a.png 2>message &
pid=$!
await_handler $pid
kill -INT $pid
code=0
wait $pid || code=$?
echo $code $(cat message)
