# The key light of a bare volume is at the upper left of every view.
tool ball 16 ball_16x16x16_uint8.raw
for azimuth in -30 60 150 240; do
  halflight render ball_16x16x16_uint8.raw --size 32x32 --quiet --azimuth $azimuth -o a.npy
  tool brightness a.npy >halves
  awk '!($1 > $2 && $3 > $4) { exit 1 }' halves
done
