tool ball 24 ball_24x24x24_uint8.raw
halflight render ball_24x24x24_uint8.raw --size 2000x2000 --max-memory 1M
