# What was asked for and has no effect is said.
tool ball 8 ball_8x8x8_uint8.raw
halflight render ball_8x8x8_uint8.raw --size 8x8 -o out.npy --shadows hard --soft-method paper --light-size 9
