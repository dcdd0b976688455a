# The ball fills the view from every side, in every shape of picture, in both projections; zoom 2 doubles it.
tool ball 16 ball_16x16x16_uint8.raw
for size in 48x48 96x48 48x96; do
  halflight render ball_16x16x16_uint8.raw --size $size --quiet -o a.npy
  tool coverage a.npy >box
  awk '!($1 >= 20 && $1 <= 48 && $2 >= 20 && $2 <= 48) { exit 1 }' box
done
halflight render ball_16x16x16_uint8.raw --size 96x96 --ortho --quiet -o one.npy
halflight render ball_16x16x16_uint8.raw --size 96x96 --ortho --zoom 0.5 --quiet -o half.npy
tool coverage one.npy >one
tool coverage half.npy >half
paste one half | awk '{ if ($1 < 1.8 * $3 || $1 > 2.2 * $3) exit 1 }'
