# The bytes are those of the file, in every format.
tool ball 16 ball_16x16x16_uint8.raw
for format in png exr npy; do
  halflight render ball_16x16x16_uint8.raw --size 24x20 --quiet -o a.$format
  halflight render ball_16x16x16_uint8.raw --size 24x20 --quiet -o - --format $format >b.$format
  cmp a.$format b.$format
done
halflight render ball_16x16x16_uint8.raw --size 24x20 --quiet -o - | cmp - a.png
halflight render ball_16x16x16_uint8.raw --size 24x20 --quiet --layers -o a.exr
halflight render ball_16x16x16_uint8.raw --size 24x20 --quiet --layers -o - --format exr | cmp - a.exr
halflight render ball_16x16x16_uint8.raw --size 24x20 --quiet --format exr
test -f ball_16x16x16_uint8.exr
# A disk that is full is told.
code=0
halflight render ball_16x16x16_uint8.raw --size 24x20 --quiet -o - >/dev/full 2>message || code=$?
echo $code $(cat message)
