# What nohup starts goes on when its terminal is gone.
# slow: a picture that outlasts its signal on a quick machine takes minutes
tool ball 16 ball_16x16x16_uint8.raw
(trap '' HUP && exec "$HALFLIGHT" render ball_16x16x16_uint8.raw --size 500x500 --sheet-spacing 0.01 --quiet -o out.npy) &
await_handler $!
kill -HUP $!
wait $!
test -s out.npy
