# The scene in the picture renders to the same bytes.
tool ball 16 ball_16x16x16_uint8.raw
set -- --size 40x30 --azimuth 100 --elevation -20 --light 30,10 --light-size 12 --shading none --colormap viridis
halflight render ball_16x16x16_uint8.raw --quiet "$@" -o a.png
halflight render ball_16x16x16_uint8.raw --quiet "$@" -o a.npy
tool coverage a.npy >box
tool png-scene a.png >again.json
halflight render again.json --quiet -o b.npy
cmp a.npy b.npy
