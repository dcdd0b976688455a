# Both exceeded limits are named, the kept one is not.
tool ball 12 ball_12x12x12_uint8.raw
halflight render ball_12x12x12_uint8.raw --size 24x24 --quiet -o a.npy
halflight render ball_12x12x12_uint8.raw --size 24x24 --quiet --zoom 1.2 -o b.npy
halflight diff a.npy b.npy --max-rmse 0.0001 --max-error 1e-4 --max-mean 1 >text
