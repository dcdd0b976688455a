[ -w /dev/full ] || { echo "no /dev/full here"; exit 77; }
tool ball 8 ball_8x8x8_uint8.raw
halflight info ball_8x8x8_uint8.raw --json >/dev/full
