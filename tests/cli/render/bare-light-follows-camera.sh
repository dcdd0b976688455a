# The key light of a bare volume is at the upper left of every view: against a headlight, left and top are brighter than right and bottom.
tool ball 16 ball_16x16x16_uint8.raw
for azimuth in -30 60 150 240; do
  halflight render ball_16x16x16_uint8.raw --size 32x32 --quiet --azimuth $azimuth --shadows off -o a.npy
  halflight render ball_16x16x16_uint8.raw --size 32x32 --quiet --azimuth $azimuth --shadows off --light 0,0 -o b.npy
  tool brightness a.npy >key
  tool brightness b.npy >head
  paste key head | awk '!($1 / $5 > 1.1 * $2 / $6 && $3 / $7 > 1.1 * $4 / $8) { exit 1 }'
done
