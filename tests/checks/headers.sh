#!/bin/sh
# Every public header compiles alone, as strict C99 and as C++11.
# usage: headers.sh INCLUDE_FOLDER CC [CXX]
set -eu
include=$1 cc=$2 cxx=${3-}
for header in "$include"/halflight/*.h; do
  name=halflight/$(basename "$header")
  printf '#include <%s>\n' "$name" |
    $cc -std=c99 -pedantic-errors -Wall -Wextra -Werror -fsyntax-only -I"$include" -x c -
  if [ -n "$cxx" ]; then
    printf '#include <%s>\n' "$name" |
      $cxx -std=c++11 -pedantic-errors -Wall -Wextra -Werror -fsyntax-only -I"$include" -x c++ -
  fi
done
[ -n "$cxx" ] || { echo "no C++ compiler: headers were compiled as C only"; exit 77; }
