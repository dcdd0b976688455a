#!/bin/sh
# The manual page formats without a warning.
# usage: manual.sh PAGE
set -eu
command -v man >/dev/null || { echo "man is not installed"; exit 77; }
warnings=$(MANWIDTH=80 LC_ALL=C.UTF-8 man --warnings -E UTF-8 -l -Tutf8 -Z "$1" 2>&1 >/dev/null)
[ -z "$warnings" ] || { echo "$warnings"; exit 1; }
