# A PNG holds no layers, nor does the default name.
tool ball 12 ball_12x12x12_uint8.raw
if halflight render ball_12x12x12_uint8.raw --layers -o ball.png; then exit 1; fi
if halflight render ball_12x12x12_uint8.raw --layers; then exit 1; fi
