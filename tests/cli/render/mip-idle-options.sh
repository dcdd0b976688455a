# Options of light change nothing in a maximum projection, which is said.
tool ball 8 ball_8x8x8_uint8.raw
halflight render ball_8x8x8_uint8.raw --size 8x8 -o out.npy --look mip --shadows hard --ambient 1
