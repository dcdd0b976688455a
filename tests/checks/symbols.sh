#!/bin/sh
# The shared library exports exactly the functions that the public headers declare. It takes no function from the C library whose last bits
# differ between machines: elementary/elementary.h has its own.
# usage: symbols.sh LIBRARY INCLUDE_FOLDER
set -eu
library=$1 include=$2
exported=$(nm -D --defined-only "$library" | awk '{ print $3 }' | sort)
# Declarations may span lines: the name is the word before the first parenthesis after HL_API.
declared=$(cat "$include"/halflight/*.h | grep -v '^#' | tr '\n' ' ' |
  grep -o 'HL_API[^;(]*(' | sed 's/($//; s/.*[ *]//' | sort -u)
[ "$(echo "$declared" | wc -l)" -ge 40 ] || { echo "fewer than 40 declarations were found"; exit 1; }
if [ "$exported" != "$declared" ]; then
  echo "exported:" && echo "$exported" >&1
  echo "declared:" && echo "$declared"
  exit 1
fi
inexact='acos|asin|atan|atan2|cbrt|cos|cosh|erf|erfc|exp|exp10|exp2|expm1|hypot|lgamma|log|log10|log1p|log2|pow|sin|sincos|sinh|tan|tanh|tgamma'
taken=$(nm -D --undefined-only "$library" | awk '{ sub(/@.*/, "", $2); print $2 }' | grep -E "^($inexact)[fl]?\$" || true)
if [ -n "$taken" ]; then
  echo "functions of the C library that differ between machines:" && echo "$taken"
  exit 1
fi
