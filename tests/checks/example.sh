#!/bin/sh
# The example program in halflight.h compiles as C99, links, and turns a volume into a picture.
# usage: example.sh INCLUDE_FOLDER LIBRARY_FOLDER MAKE_VOLUME CC [FLAG ...]
set -eu
include=$1 library=$2 make_volume=$3
shift 3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
sed -n '/^ \*     #include/,/^ \*     }$/s/^ \*     \{0,1\}//p' "$include/halflight/halflight.h" >"$folder/picture.c"
grep -q 'int main' "$folder/picture.c"
"$@" -std=c99 -pedantic-errors -Wall -Wextra -Werror -I"$include" "$folder/picture.c" -o "$folder/picture" \
  -L"$library" -lhalflight -Wl,-rpath,"$library"
"$make_volume" ball 24 "$folder/ball_24x24x24_uint8.raw"
"$folder/picture" "$folder/ball_24x24x24_uint8.raw" "$folder/ball.png"
head -c 8 "$folder/ball.png" | od -An -tx1 | grep -q '89 50 4e 47 0d 0a 1a 0a'
if "$folder/picture" "$folder/missing.nrrd" "$folder/missing.png" 2>"$folder/message"; then
  echo "a missing volume went unnoticed"
  exit 1
fi
grep -q missing.nrrd "$folder/message"
