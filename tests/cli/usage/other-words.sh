# Words of other programs that mean one option are this option, and help tells them.
tool ball 16 ball_16x16x16_uint8.raw
halflight help render >help
for pair in 'tf preset ct-bone' 'iso isosurface 120' 'channel channels 0' 'sky environment #89f'; do
  set -- $pair
  halflight render ball_16x16x16_uint8.raw --size 24x24 --quiet --$1 "$3" -o own.npy
  halflight render ball_16x16x16_uint8.raw --size 24x24 --quiet --$2 "$3" -o other.npy
  cmp own.npy other.npy
  grep -q "  also --$2$" help
done
halflight render ball_16x16x16_uint8.raw --iso 120 --preset ct-bone --isosurface 80 --size 8x8 --quiet -o both.npy
halflight help animate >help # where --preset is an option of its own
grep -q '  --preset turntable' help
grep -c 'also --preset' help || true
