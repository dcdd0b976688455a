# A name that no file can have, and one that leaves no room for the layers' names, are told before the work, not after.
tool ball 16 ball_16x16x16_uint8.raw
code() { halflight render ball_16x16x16_uint8.raw --quiet "$@" && echo 0 || echo $?; }
code -o "$(printf '%0252d' 7).png" --size 16x16
code --layers -o "$(printf '%0251d' 7).npy" --reference --size 4000x4000
test "$(ls)" = ball_16x16x16_uint8.raw
