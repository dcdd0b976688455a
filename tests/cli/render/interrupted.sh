# SIGINT, SIGTERM and SIGHUP end a long run with 130; nothing is left behind, and the old picture stands.
tool ball 40 ball_40x40x40_uint8.raw
echo old >keep.npy
for signal in INT TERM HUP; do
  "$HALFLIGHT" render ball_40x40x40_uint8.raw --size 1024x1024 --sheet-spacing 0.01 \
    --soft-method sublights --light-samples 8 --quiet -o keep.npy 2>/dev/null &
  await_handler $!
  kill -$signal $!
  code=0
  wait $! || code=$?
  echo $code
done
test "$(cat keep.npy)" = old
echo *
