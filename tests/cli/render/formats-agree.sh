tool ball 12 ball_12x12x12_uint8.raw
halflight render ball_12x12x12_uint8.raw --size 32x32 --quiet -o a.npy
tool coverage a.npy >box
halflight render ball_12x12x12_uint8.raw --size 32x32 --quiet -o a.exr
halflight render ball_12x12x12_uint8.raw --size 32x32 --quiet -o a.png --depth 16 --background transparent
halflight diff a.npy a.exr --max-error 0 >text
# 16 bits of sRGB, and a colour that is stored divided by alpha: a few parts in ten thousand.
halflight diff a.npy a.png --max-rmse 2e-4 >text
