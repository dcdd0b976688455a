# A name may be as long as the system allows; the temporary file's is no longer, and ends between two characters.
tool ball 16 ball_16x16x16_uint8.raw
long=$(printf '%0251d' 7).png
halflight render ball_16x16x16_uint8.raw --size 16x16 --quiet -o $long
test -s $long
other=n$(printf '%.0s\303\251' $(seq 125)).npy
halflight render ball_16x16x16_uint8.raw --size 16x16 --quiet -o $other
test -s $other
test "$(ls | wc -l)" = 3
