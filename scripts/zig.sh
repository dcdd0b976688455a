# shellcheck shell=sh
# Sourced by the scripts that build for other systems: ziglang's compilers, and libraries from Debian's sources.
#
# The caller sets `out`, the folder of its build, `library_target`, zig's name of the system, `library_flags`, more flags of the compiler, and
# `archive_format`, as `zig ar` calls it. The compilers and the sources lie in build-zig/, where all of these scripts share them.
shared_folder=$PWD/build-zig

install_zig() {
  root=$out/root sources=$shared_folder/sources tools=$shared_folder/tools
  mkdir -p "$root"
  [ -x "$tools/bin/meson" ] || { python3 -m venv "$tools" && "$tools/bin/python" -m pip install -q meson==1.12.1 ziglang==0.17.1; }
  zig=$("$tools/bin/python" -c 'import os, ziglang; print(os.path.dirname(ziglang.__file__))')
}

# list_sources [ADDRESS SUITE COMPONENT]: makes the lists that apt_get uses, in a folder of this build, of the sources of this system's release or of
# another one. The machine's own lists may have no sources.
list_sources() {
  lists=$shared_folder/apt
  rm -rf "$lists"
  mkdir -p "$lists/lists/partial" "$lists/archives/partial" "$sources"
  if [ $# -gt 0 ]; then
    echo "deb-src $*" >"$lists/sources.list"
  else
    cat /etc/apt/sources.list /etc/apt/sources.list.d/debian.sources 2>/dev/null | sed 's/^deb /deb-src /; s/^Types: .*/Types: deb-src/' >"$lists/sources.sources"
    grep -q '^deb-src' "$lists/sources.sources" && mv "$lists/sources.sources" "$lists/sources.list"
  fi
  apt_get update
}

apt_get() {
  apt-get -q -o Dir::Etc::sourcelist="$(ls "$lists"/sources.*)" -o Dir::Etc::sourceparts=/dev/null -o Dir::State="$lists" \
    -o Dir::Cache="$lists" -o Debug::NoLocking=true -o APT::Sandbox::User=root "$@"
}

# fetch_sources PACKAGE ...: the sources of Debian packages, as far as they are not there. Where the security updates that are listed are gone, the
# release's own sources serve.
fetch_sources() {
  lists=
  release=$(. /etc/os-release && echo "$VERSION_CODENAME")
  for package in "$@"; do
    [ ! -f "$sources/$package.fetched" ] || continue
    [ -n "$lists" ] || list_sources
    (cd "$sources" && { apt_get source --only-source "$package" || apt_get source --only-source "$package/$release"; })
    touch "$sources/$package.fetched"
  done
  rm -rf "$shared_folder/apt"
}

# fetch_original SUITE PACKAGE: a package's sources as their authors published them, of another release of Debian.
fetch_original() {
  [ ! -f "$sources/$2.fetched" ] || return 0
  list_sources http://deb.debian.org/debian "$1" main
  (cd "$sources" && apt_get source --only-source --tar-only "$2" && tar -xf "$2"_*.orig.tar.*)
  touch "$sources/$2.fetched"
  rm -rf "$shared_folder/apt"
}

# library NAME FOLDER FILE ...: compiles files of a folder to root/lib/libNAME.a.
library() {
  name=$1 folder=$2
  shift 2
  mkdir -p "$root/objects/$name" "$root/lib"
  for file in "$@"; do
    # shellcheck disable=SC2086 # several flags
    "$zig/zig" cc -w -target "$library_target" -O2 $library_flags \
      -DHAVE_UNISTD_H -DHAVE_STDINT_H -DHAVE_SYS_TYPES_H -DHAVE_STRTOLL -I"$root/include" -c "$folder/$file.c" -o "$root/objects/$name/$(basename "$file").o"
  done
  rm -f "$root/lib/lib$name.a"
  "$zig/zig" ar --format="$archive_format" rcs "$root/lib/lib$name.a" "$root/objects/$name"/*.o
  rm -rf "$root/objects"
}

# package NAME LIBRARY VERSION: what pkg-config says of it.
package() {
  mkdir -p "$root/lib/pkgconfig"
  printf 'Name: %s\nDescription: %s\nVersion: %s\nLibs: -L%s -l%s\nCflags: -I%s\n' "$1" "$1" "$3" "$root/lib" "$2" "$root/include" \
    >"$root/lib/pkgconfig/$1.pc"
}

# zlib, libpng and jansson. EXTRA ...: more files of libpng's folder.
build_base_libraries() {
  mkdir -p "$root/include"
  z=$(echo "$sources"/zlib-*/) png=$(echo "$sources"/libpng*-*/) jansson=$(echo "$sources"/jansson-*/)
  cp "$z"zlib.h "$z"zconf.h "$png"png.h "$png"pngconf.h "$jansson"src/jansson.h "$jansson"android/jansson_config.h "$root/include"
  # libpng's own option: it computes in integers, and takes no power or logarithm from the system.
  sed '/PNG_FLOATING_ARITHMETIC_SUPPORTED/d' "$png"scripts/pnglibconf.h.prebuilt >"$root/include/pnglibconf.h"
  : >"$root/include/jansson_private_config.h"
  library z "$z" adler32 compress crc32 deflate inffast inflate inftrees trees uncompr zutil
  library png "$png" png pngerror pngget pngmem pngpread pngread pngrio pngrtran pngrutil pngset pngtrans pngwio pngwrite pngwtran pngwutil "$@"
  library jansson "${jansson}src" dump error hashtable hashtable_seed load memory pack_unpack strbuffer strconv utf value version
  package zlib z "$(sed -n 's/#define ZLIB_VERSION "\([0-9.]*\).*/\1/p' "$z"zlib.h)"
  package libpng png "$(sed -n 's/#define PNG_LIBPNG_VER_STRING "\(.*\)"/\1/p' "$png"png.h)"
  package jansson jansson "$(sed -n 's/#define JANSSON_VERSION  *"\(.*\)"/\1/p' "$jansson"src/jansson.h)"
}

# bzip2, LZ4 and Zstandard.
build_codec_libraries() {
  bzip2=$(echo "$sources"/bzip2-*/) lz4=$(echo "$sources"/lz4-*/)lib/ zstd=$(echo "$sources"/libzstd-*/)lib/
  cp "$bzip2"bzlib.h "$lz4"lz4.h "$lz4"lz4hc.h "$zstd"zstd.h "$zstd"zstd_errors.h "$root/include"
  library bz2 "$bzip2" blocksort bzlib compress crctable decompress huffman randtable
  library lz4 "$lz4" lz4 lz4hc
  usual_flags=$library_flags
  library_flags="$library_flags -DZSTD_DISABLE_ASM"
  # shellcheck disable=SC2046 # several names
  library zstd "$zstd" $(cd "$zstd" && ls common/*.c compress/*.c decompress/*.c | sed 's/\.c$//')
  library_flags=$usual_flags
  package liblz4 lz4 "$(sed -n 's/#define LZ4_VERSION_\(MAJOR\|MINOR\|RELEASE\) *\([0-9]*\).*/\2/p' "$lz4"lz4.h | paste -sd.)"
  package libzstd zstd "$(sed -n 's/#define ZSTD_VERSION_\(MAJOR\|MINOR\|RELEASE\) *\([0-9]*\).*/\2/p' "$zstd"zstd.h | paste -sd.)"
}
