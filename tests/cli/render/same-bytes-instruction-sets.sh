# Every instruction set that this machine has gives the bytes of the scalar one, however the sheets are filled.
# slow: it renders thirty pictures
tool ball 20 ball_20x20x20_uint8.raw
compared=0
for how in splat gather; do
  for kernel in bspline gaussian linear interpolating; do
    set -- --size 61x47 --quiet --reconstruction $how --kernel $kernel
    halflight render ball_20x20x20_uint8.raw "$@" --instruction-set scalar -o scalar.npy
    tool coverage scalar.npy >box
    for set in avx2 avx512 avx512-vbmi neon; do
      code=0
      halflight render ball_20x20x20_uint8.raw "$@" --instruction-set $set -o other.npy 2>message || code=$?
      case $code in
        0) cmp scalar.npy other.npy && compared=$((compared + 1)) ;;
        4) grep -q "instruction set $set" message ;;
        *) cat message && exit 1 ;;
      esac
    done
  done
done
[ $compared -gt 0 ] || { echo "this processor has the scalar instruction set only"; exit 77; }
