head -c 4000 /dev/zero >cut_16x16x16_uint8.raw
halflight info cut_16x16x16_uint8.raw
