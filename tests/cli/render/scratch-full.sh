# Where the scratch folder is missing or has no room, one line says so and there is no picture.
# slow: 4 seconds of processor time
tool ball 176 ball_176x176x176_uint8.raw
trap '' XFSZ
export TMPDIR=$PWD
(ulimit -f 1 && halflight render ball_176x176x176_uint8.raw --max-memory 12M --quiet -o out.npy) || echo $?
export TMPDIR=/nowhere
halflight render ball_176x176x176_uint8.raw --max-memory 12M --quiet -o out.npy || echo $?
ls
