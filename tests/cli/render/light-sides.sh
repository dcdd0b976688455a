# Without a sky, a light from the left brightens the left half, and so on for the four sides; the light follows the camera.
tool ball 16 ball_16x16x16_uint8.raw
render() { halflight render ball_16x16x16_uint8.raw --size 32x32 --quiet --ambient 0.2 --azimuth "$1" --light "$2" -o a.npy; }
for azimuth in -30 120; do
  render $azimuth -80,0 && tool brightness a.npy >left
  render $azimuth 80,0 && tool brightness a.npy >right
  render $azimuth 0,80 && tool brightness a.npy >above
  render $azimuth 0,-80 && tool brightness a.npy >below
  awk '!($1 > 1.3 * $2) { exit 1 }' left
  awk '!($2 > 1.3 * $1) { exit 1 }' right
  awk '!($3 > 1.3 * $4) { exit 1 }' above
  awk '!($4 > 1.3 * $3) { exit 1 }' below
done
