tool ball 12 ball_12x12x12_uint8.raw
halflight render ball_12x12x12_uint8.raw --size 24x16 --quiet -o a.npy
halflight diff a.npy a.npy --max-rmse 0 --max-error 0 --max-p999 0 --max-mean 0 >text
grep -q '^rmse           0$' text
grep -q '^pixels         0 of 384 differ$' text
