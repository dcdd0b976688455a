tool ball 16 ball_16x16x16_uint8.raw
halflight info ball_16x16x16_uint8.raw >text
grep -q '^  dimensions  16 x 16 x 16 (4096 voxels)$' text
grep -q '^  type        uint8$' text
grep -q '^  spacing     1, 1, 1$' text
grep -q '^  world box   x -0.5 to 15.5, y -0.5 to 15.5, z -0.5 to 15.5$' text
grep -q '^  taken for   scanned matter' text
grep -q '^  next best   --look translucent$' text
grep -q '^  range       0 to 255, mean ' text
test "$(grep -c '%$' text)" -eq 16
# The unit of lengths and the directions of a body, where the file tells them; else the options that state them.
grep -q '^  unit        not told by the file: --unit mm' text
grep -q '^  space       not told by the file: --space RAS' text
halflight info ball_16x16x16_uint8.raw --space LAS --unit nm >stated
grep -q '^  unit        nm$' stated
grep -q '^  space       LAS$' stated
halflight convert --quiet ball_16x16x16_uint8.raw ball.mrc
halflight info ball.mrc | grep -q '^  unit        angstrom$'
# A series of plain volumes has time steps, not components.
printf 'NDims = 4\nDimSize = 2 1 1 3\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n123456' >s.mha
if halflight info s.mha --time 2 | grep arrays; then exit 9; fi
