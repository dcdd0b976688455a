tool ball 12 ball_12x12x12_uint8.raw
halflight render ball_12x12x12_uint8.raw --size 16x16 --quiet
