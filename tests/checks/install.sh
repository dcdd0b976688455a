#!/bin/sh
# What `meson install` installs is whole: the example program in halflight.h compiles as C99 with the
# flags of pkg-config, links, and turns a volume into a picture; program, manual and completion are there.
# usage: install.sh BUILD_FOLDER MAKE_VOLUME CC [FLAG ...]
set -eu
build=$1 make_volume=$2
shift 2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
meson install -C "$build" --no-rebuild --quiet --destdir "$folder/root"

find_one() { find "$folder/root" -path "$1" | grep . || { echo "$1 is not installed"; exit 1; }; }
pc=$(find_one '*/pkgconfig/halflight.pc')
header=$(find_one '*/include/halflight/halflight.h')
library=$(find_one '*/libhalflight.so.0')
program=$(find_one '*/bin/halflight')
find_one '*/man/man1/halflight.1*' >/dev/null
find_one '*/bash-completion/completions/halflight' >/dev/null

PKG_CONFIG_PATH=$(dirname "$pc")
PKG_CONFIG_SYSROOT_DIR=$folder/root
LD_LIBRARY_PATH=$(dirname "$library")
export PKG_CONFIG_PATH PKG_CONFIG_SYSROOT_DIR LD_LIBRARY_PATH

sed -n '/^ \*     #include/,/^ \*     }$/s/^ \*     \{0,1\}//p' "$header" >"$folder/picture.c"
grep -q 'int main' "$folder/picture.c"
# shellcheck disable=SC2046 # one word per flag
"$@" -std=c99 -pedantic-errors -Wall -Wextra -Werror "$folder/picture.c" -o "$folder/picture" \
  $(pkg-config --cflags --libs halflight)

"$make_volume" ball 24 "$folder/ball_24x24x24_uint8.raw"
"$folder/picture" "$folder/ball_24x24x24_uint8.raw" "$folder/ball.png"
head -c 8 "$folder/ball.png" | od -An -tx1 | grep -q '89 50 4e 47 0d 0a 1a 0a'
if "$folder/picture" "$folder/missing.nrrd" "$folder/missing.png" 2>"$folder/message"; then
  echo "a missing volume went unnoticed"
  exit 1
fi
grep -q missing.nrrd "$folder/message"
"$program" info "$folder/ball_24x24x24_uint8.raw" | grep -q '24 x 24 x 24'
