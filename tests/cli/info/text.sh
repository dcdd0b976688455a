tool ball 16 ball_16x16x16_uint8.raw
halflight info ball_16x16x16_uint8.raw >text
grep -q '^  dimensions  16 x 16 x 16 (4096 voxels)$' text
grep -q '^  type        uint8$' text
grep -q '^  spacing     1, 1, 1$' text
grep -q '^  world box   x -0.5 to 15.5, y -0.5 to 15.5, z -0.5 to 15.5$' text
grep -q '^  taken for   scanned matter' text
grep -q '^  range       0 to 255, mean ' text
test "$(grep -c '%$' text)" -eq 16
