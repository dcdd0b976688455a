# Linear 0.5 is 188 of 255 in sRGB. The corner of a framed ball is background alone.
tool ball 12 ball_12x12x12_uint8.raw
halflight render ball_12x12x12_uint8.raw --size 32x32 --quiet --background 1,0,0.5 -o a.png
tool png-pixel a.png 0 0
halflight render ball_12x12x12_uint8.raw --size 32x32 --quiet --background transparent -o b.png
tool png-pixel b.png 0 0
# The floats hold the volume alone, whatever the background.
halflight render ball_12x12x12_uint8.raw --size 32x32 --quiet -o plain.npy
halflight render ball_12x12x12_uint8.raw --size 32x32 --quiet --background 1,0,0.5 -o colored.npy
cmp plain.npy colored.npy
