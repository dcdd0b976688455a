# A picture that cannot be written harms nothing: the old one stands, and no temporary file is left.
[ "$(id -u)" -ne 0 ] || command -v setpriv >/dev/null || { echo "needs setpriv, or a user other than root"; exit 77; }
mkdir locked
tool ball 8 ball_8x8x8_uint8.raw
echo old >locked/out.npy
chmod 755 . && chmod 644 ball_8x8x8_uint8.raw && chmod 555 locked
set -- "$HALFLIGHT" render ball_8x8x8_uint8.raw --size 8x8 --quiet -o locked/out.npy
[ "$(id -u)" -ne 0 ] || set -- setpriv --reuid=65534 --regid=65534 --clear-groups "$@"
code=0
"$@" 2>message || code=$?
test $code -eq 1
grep -q 'locked' message
cat locked/out.npy
ls locked >listing
test "$(cat listing)" = out.npy
echo locked
