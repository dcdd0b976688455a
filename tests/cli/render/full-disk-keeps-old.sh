# A write that fails half way, here at a limit of file sizes, harms nothing: the old picture stands, and
# no temporary file is left.
tool ball 8 ball_8x8x8_uint8.raw
trap '' XFSZ
for extension in npy exr png; do
  echo old >out.$extension
  code=0
  (ulimit -f 1 && halflight render ball_8x8x8_uint8.raw --size 64x48 --quiet -o out.$extension) 2>message || code=$?
  test $code -eq 1
  grep -q "^halflight: .*out.$extension" message
  test "$(cat out.$extension)" = old
done
rm message
ls
