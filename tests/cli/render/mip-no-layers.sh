tool ball 8 ball_8x8x8_uint8.raw
halflight render ball_8x8x8_uint8.raw --size 8x8 --quiet -o out.exr --look mip --layers
