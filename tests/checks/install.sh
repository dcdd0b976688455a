#!/bin/sh
# What `meson install` installs is whole: the example program picture.c compiles as C99 with the
# flags of pkg-config, links, and turns a volume into a picture; program, manual and completion are there. On a bare
# Debian, without dpkg-dev, all of it goes where the loader and pkg-config look without being told.
# usage: install.sh SOURCE_FOLDER BUILD_FOLDER MAKE_VOLUME CC [FLAG ...]
set -eu
source=$1 build=$2 make_volume=$3
shift 3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
unset LD_LIBRARY_PATH
meson install -C "$build" --no-rebuild --quiet --destdir "$folder/root"

find_one() { find "$folder/root" -path "$1" | grep . || { echo "$1 is not installed"; exit 1; }; }
pc=$(find_one '*/pkgconfig/halflight.pc')
header=$(find_one '*/include/halflight/halflight.h')
library=$(find_one '*/libhalflight.so.0')
program=$(find_one '*/bin/halflight')
find_one '*/man/man1/halflight.1*' >/dev/null
find_one '*/bash-completion/completions/halflight' >/dev/null

# Without dpkg-dev Meson cannot ask dpkg-architecture; it must still choose "lib".
mkdir "$folder/no-dpkg-dev"
ln -s /bin/false "$folder/no-dpkg-dev/dpkg-architecture"
PATH="$folder/no-dpkg-dev:$PATH" meson introspect --buildoptions "$source/meson.build" >"$folder/options.json"
place=$(python3 -c "import json, sys
print(*(option['value'] for option in json.load(open(sys.argv[1])) if option['name'] == 'libdir'))" "$folder/options.json")
[ "$place" = lib ] || { echo "without dpkg-dev the library would go to $place"; exit 1; }

# The program starts where it was put: nothing tells the loader where.
"$program" --version >/dev/null || { echo "the installed program does not start"; exit 1; }
"$make_volume" ball 24 "$folder/ball_24x24x24_uint8.raw"
"$program" info "$folder/ball_24x24x24_uint8.raw" | grep -q '24 x 24 x 24'

# So is the viewer's page without a server, where there is one.
if [ -n "$(find "$folder/root" -path '*/share/halflight/halflight.html')" ]; then
  env -u HALFLIGHT_PAGE "$program" export "$folder/ball_24x24x24_uint8.raw" -o "$folder/ball.html" --quiet
  grep -q 'data-file="scene.json"' "$folder/ball.html"
fi

# The viewer's module is found where it was put, too: the URL of its page is printed.
if [ -n "$(find "$folder/root" -name halflight-viewer.so)" ]; then
  "$program" view "$folder/ball_24x24x24_uint8.raw" --no-browser --quiet >"$folder/url" &
  viewer=$!
  for _ in $(seq 3000); do
    if grep -q . "$folder/url" || ! kill -0 $viewer 2>/dev/null; then break; fi
    sleep 0.1
  done
  kill -INT $viewer || true
  wait $viewer || { echo "the installed viewer does not start"; exit 1; }
  grep -q '^http://127.0.0.1:' "$folder/url"
fi

PKG_CONFIG_PATH=$(dirname "$pc")
PKG_CONFIG_SYSROOT_DIR=$folder/root
export PKG_CONFIG_PATH PKG_CONFIG_SYSROOT_DIR

cp "$(find_one '*/share/doc/halflight/examples/picture.c')" "$folder"
# shellcheck disable=SC2046 # one word per flag
"$@" -std=c99 -pedantic-errors -Wall -Wextra -Werror "$folder/picture.c" -o "$folder/picture" \
  $(pkg-config --cflags --libs halflight)

# CMake finds the package where it was put, compiles the same program, and refuses a version that is not there.
find_one '*/cmake/halflight/halflightConfig.cmake' >/dev/null
if command -v cmake >/dev/null; then
  mkdir "$folder/cmake"
  cp "$folder/picture.c" "$folder/cmake"
  prefix=$(dirname "$(dirname "$(dirname "$header")")")
  project() {
    cat >"$folder/cmake/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.16)
project(picture C)
find_package(halflight $1 REQUIRED CONFIG)
add_executable(picture picture.c)
target_link_libraries(picture PRIVATE halflight::halflight)
END
    rm -rf "$folder/cmake/build"
    cmake -S "$folder/cmake" -B "$folder/cmake/build" -DCMAKE_PREFIX_PATH="$prefix" >"$folder/cmake/told" 2>&1
  }
  project 0.1 && cmake --build "$folder/cmake/build" >>"$folder/cmake/told" 2>&1 || { cat "$folder/cmake/told"; exit 1; }
  LD_LIBRARY_PATH=$(dirname "$library") "$folder/cmake/build/picture" "$folder/ball_24x24x24_uint8.raw" "$folder/cmake/ball.png"
  ! project 9.9 || { echo "CMake takes this version for 9.9"; exit 1; }
else
  echo "cmake is not installed: its package file was not tried"
fi

picture() { LD_LIBRARY_PATH=$(dirname "$library") "$folder/picture" "$@"; }
picture "$folder/ball_24x24x24_uint8.raw" "$folder/ball.png"
head -c 8 "$folder/ball.png" | od -An -tx1 | grep -q '89 50 4e 47 0d 0a 1a 0a'
if picture "$folder/missing.nrrd" "$folder/missing.png" 2>"$folder/message"; then
  echo "a missing volume went unnoticed"
  exit 1
fi
grep -q missing.nrrd "$folder/message"

# In a root folder that has nothing but Debian's own libraries and its loader's list of folders, both programs start.
if [ "$(id -u)" = 0 ]; then as_root=; else as_root='unshare -r'; fi
if [ ! -x "$folder/root/usr/local/bin/halflight" ] || ! $as_root chroot / true 2>/dev/null; then
  echo "not tried in a root folder of its own: that takes the prefix /usr/local and the right to chroot"
  exit 0
fi
for name in $(LD_LIBRARY_PATH=$(dirname "$library") ldd "$folder/picture" "$program" | grep -o '/[^ ]*' | grep -v "^$folder"); do
  mkdir -p "$folder/root$(dirname "$name")"
  cp -L "$name" "$folder/root$name"
done
mkdir -p "$folder/root/etc" "$folder/root/tmp"
cp -r /etc/ld.so.conf /etc/ld.so.conf.d "$folder/root/etc"
cp "$folder/picture" "$folder/ball_24x24x24_uint8.raw" "$folder/root"
PATH=$PATH:/usr/sbin:/sbin
$as_root ldconfig -r "$folder/root"
$as_root chroot "$folder/root" /usr/local/bin/halflight info /ball_24x24x24_uint8.raw | grep -q '24 x 24 x 24'
$as_root chroot "$folder/root" /picture /ball_24x24x24_uint8.raw /tmp/ball.png
cmp "$folder/ball.png" "$folder/root/tmp/ball.png"
