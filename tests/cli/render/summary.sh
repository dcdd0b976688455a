# Without a terminal there is no progress bar, only the line of summary; standard output is empty.
tool ball 12 ball_12x12x12_uint8.raw
halflight render ball_12x12x12_uint8.raw --size 16x8 --shadows hard -o out.npy
