# With one ray through each pixel a small picture has the pixels of a larger one, where the default averages.
tool ball 16 ball_16x16x16_uint8.raw
set -- ball_16x16x16_uint8.raw --quiet --reference --shadows off
halflight render "$@" --size 15x15 --rays 1 -o larger.npy
halflight render "$@" --size 5x5 --rays 1 -o small.npy
halflight render "$@" --size 5x5 -o mean.npy
tool shared-pixels larger.npy small.npy
tool shared-pixels small.npy mean.npy
code=0
halflight render ball_16x16x16_uint8.raw --rays 2 2>message || code=$?
echo $code $(cat message)
