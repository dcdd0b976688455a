# A volume that the memory limit has no room for is rendered from a scratch file, with the same bytes, whether it
# is compressed or not; the scratch file is gone afterwards.
# slow: 7 seconds of processor time
tool ball 176 ball_176x176x176_uint8.raw
halflight convert ball_176x176x176_uint8.raw ball.nrrd --quiet
mkdir scratch
export TMPDIR=$PWD/scratch
for volume in ball_176x176x176_uint8.raw ball.nrrd; do
  halflight render $volume --size 60x50 --ambient 0.2 --shadow-resolution 64 --shadows hard --quiet -o large.npy
  halflight render $volume --size 60x50 --ambient 0.2 --shadow-resolution 64 --shadows hard --quiet -o small.npy --max-memory 12M
  cmp large.npy small.npy
done
ls scratch
halflight info ball.nrrd --json --max-memory 6M >small.json
halflight info ball.nrrd --json >large.json
cmp small.json large.json
