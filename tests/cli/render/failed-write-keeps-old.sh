# A picture that cannot be written harms nothing: the old one stands, and no temporary file is left.
# Root may write anywhere, and so becomes somebody else.
mkdir locked
tool ball 8 ball_8x8x8_uint8.raw
echo old >locked/out.npy
chmod 755 . && chmod 644 ball_8x8x8_uint8.raw && chmod 555 locked
set --
[ "$(id -u)" -ne 0 ] || set -- setpriv --reuid=65534 --regid=65534 --clear-groups
"$@" "$HALFLIGHT" --version >version 2>&1 || { echo "another user cannot run the program"; exit 77; }
code=0
"$@" "$HALFLIGHT" render ball_8x8x8_uint8.raw --size 8x8 --quiet -o locked/out.npy 2>message || code=$?
test $code -eq 1
grep -q 'locked' message
cat locked/out.npy
ls locked
