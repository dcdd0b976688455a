tool ball 20 ball_20x20x20_uint8.raw
halflight render ball_20x20x20_uint8.raw --size 61x47 --quiet --reconstruction splat -o splat.npy
halflight render ball_20x20x20_uint8.raw --size 61x47 --quiet --reconstruction gather -o gather.npy
tool coverage splat.npy >box
halflight diff splat.npy gather.npy --max-rmse 1e-4 --max-mean 1e-5 >text
