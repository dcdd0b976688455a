#!/bin/sh
# What a C developer copies works as it stands: the installed examples compile as C99 and as
# C++11 without a warning, by the flags of the installed pkg-config file; they make their pictures, give back all memory (so
# the address sanitizer says, also where they fail), and say what is wrong with a volume that is not there.
# usage: examples.sh BUILD_FOLDER MAKE_VOLUME PROGRAM CXX CC [FLAG ...]
set -eu
build=$1 make_volume=$2 program=$(realpath "$3") cxx=$4 over_ranks=$(realpath "$(dirname "$0")/../over_ranks.sh")
shift 4
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
meson install -C "$build" --no-rebuild --quiet --destdir "$folder/root"
pc=$(find "$folder/root" -path '*/pkgconfig/halflight.pc')
examples=$(find "$folder/root" -path '*/share/doc/halflight/examples')
PKG_CONFIG_PATH=$(dirname "$pc")
PKG_CONFIG_SYSROOT_DIR=$folder/root
LD_LIBRARY_PATH=$(dirname "$(find "$folder/root" -name libhalflight.so.0)")
export PKG_CONFIG_PATH PKG_CONFIG_SYSROOT_DIR LD_LIBRARY_PATH

mkdir "$folder/work"
cp "$examples"/*.c "$folder/work"
cd "$folder/work"
[ "$(ls)" = "$(printf 'animation.c\nfrom_memory.c\nlayers.c\nover_ranks.c\npicture.c\npixels.c\npreview.c')" ] || { echo "other examples:" && ls && exit 1; }

strict='-pedantic-errors -Wall -Wextra -Werror'
sanitizer=-fsanitize=address
echo 'int main(void) { return 0; }' >nothing.c
"$@" $sanitizer nothing.c -o nothing 2>/dev/null && ./nothing 2>/dev/null || sanitizer=
[ -n "$sanitizer" ] || echo "without the address sanitizer: leaks would go unnoticed"
# shellcheck disable=SC2046,SC2086 # one word per flag
for name in animation from_memory layers over_ranks picture pixels preview; do
  "$@" -std=c99 $strict -g $sanitizer $name.c -o $name $(pkg-config --cflags --libs halflight) -lm
  [ "$cxx" = none ] || $cxx -std=c++11 $strict -x c++ $name.c -o $name-cxx $(pkg-config --cflags --libs halflight) -lm
done

"$make_volume" ball 24 ball_24x24x24_uint8.raw
run() { ./"$@" 2>message || { echo "$1 fails: $(cat message)"; exit 1; }; }
fails() { # CODE: the sanitizer's, which reports a leak, is another
  expected=$1 code=0
  shift
  ./"$@" 2>message || code=$?
  [ "$code" = "$expected" ] || { echo "$*: exit code $code: $(cat message)"; exit 1; }
}
run picture ball_24x24x24_uint8.raw picture.png
run from_memory memory.png
run animation ball_24x24x24_uint8.raw 64 48 frame
run preview ball_24x24x24_uint8.raw 64 48 turn
run pixels ball_24x24x24_uint8.raw pixels.ppm
run layers ball_24x24x24_uint8.raw lit
for name in picture animation pixels layers preview; do
  arguments=out.png
  [ $name != animation ] && [ $name != preview ] || arguments='8 8 out'
  # shellcheck disable=SC2086 # one word per argument
  fails 1 $name missing.nrrd $arguments
  grep -q 'missing.nrrd: cannot open' message
  fails 2 $name
done
fails 1 from_memory no/folder.png

# They show what the program shows: the scene's background and light, to the byte.
"$program" render ball_24x24x24_uint8.raw --quiet -o expected.png
"$program" diff expected.png picture.png --max-error 0 >differences
"$program" diff expected.png lit.png --max-rmse 1e-4 >differences
"$make_volume" ppm-of-png expected.png expected.ppm
cmp expected.ppm pixels.ppm
"$make_volume" png-header frame-23.png | grep -q '^64 48 8 2$'
[ "$(ls frame-*.png | wc -l)" = 24 ]
[ "$(ls turn-*.png | wc -l)" = 25 ]
"$make_volume" png-header turn-rest.png | grep -q '^64 48 8 2$'
! cmp -s frame-00.png frame-06.png
"$make_volume" png-header memory.png | grep -q '^480 360 8 2$'
"$program" diff memory.png memory.png >differences
! "$program" diff lit.png lit-evening.png --max-rmse 0.01 >differences 2>&1
# Blocks of the same field in several processes, whatever their number.
for mpi in open_mpi mpich; do
  for ranks in 4 7; do
    "$over_ranks" $mpi $ranks ./over_ranks over_ranks.png >message 2>&1 || {
      [ $? = 77 ] && continue
      echo "over_ranks fails by $mpi: $(cat message)"
      exit 1
    }
    cmp memory.png over_ranks.png
    rm over_ranks.png
  done
done
if [ "$cxx" != none ]; then
  run from_memory-cxx cxx.png
  cmp memory.png cxx.png
fi
