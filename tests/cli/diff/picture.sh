tool ball 12 ball_12x12x12_uint8.raw
halflight render ball_12x12x12_uint8.raw --size 24x16 --quiet -o a.npy
halflight render ball_12x12x12_uint8.raw --size 24x16 --quiet --shadows off -o b.npy
halflight diff a.npy b.npy -o where.png >text
halflight diff a.npy b.npy --amplify 3 -o where.npy >text
tool png-header where.png
