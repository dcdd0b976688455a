#!/bin/sh
# The manual pages format without a warning.
# usage: manual.sh PAGE ...
set -eu
command -v man >/dev/null || { echo "man is not installed"; exit 77; }
for page in "$@"; do
  warnings=$(MANWIDTH=80 LC_ALL=C.UTF-8 man --warnings -E UTF-8 -l -Tutf8 -Z "$page" 2>&1 >/dev/null)
  [ -z "$warnings" ] || { echo "$page: $warnings"; exit 1; }
done
