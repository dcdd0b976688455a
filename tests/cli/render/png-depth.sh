tool ball 12 ball_12x12x12_uint8.raw
halflight render ball_12x12x12_uint8.raw --size 16x8 --quiet -o a.png
tool png-header a.png
halflight render ball_12x12x12_uint8.raw --size 16x8 --quiet -o b.png --depth 16
tool png-header b.png
halflight render ball_12x12x12_uint8.raw --size 16x8 --quiet -o c.png --background transparent
tool png-header c.png
