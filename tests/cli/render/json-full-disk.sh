[ -w /dev/full ] || { echo "no /dev/full here"; exit 77; }
tool ball 8 ball_8x8x8_uint8.raw
halflight render ball_8x8x8_uint8.raw --size 8x8 --json -o out.npy >/dev/full
