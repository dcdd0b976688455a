#!/bin/sh
# scripts/gallery renders what it is asked for, writes its index, and refuses what it does not know.
# usage: gallery.sh SOURCE_FOLDER PROGRAM
set -eu
source=$1 program=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
gallery() { "$source/scripts/gallery" --program "$program" --data "$folder/none" --output "$folder" "$@"; }
refused() {
  code=0
  gallery "$@" >"$folder/out" 2>"$folder/err" || code=$?
  [ "$code" = "$expected" ] || { echo "gallery $*: exit code $code, not $expected"; exit 1; }
}
expected=2
refused --size 0
refused --sise 16
refused fig04-rings
expected=1
refused --only "no such scene"
grep -q "no such scene" "$folder/err"

gallery --only rings --size 16 >"$folder/out"
[ "$(ls "$folder"/*.png | wc -l)" = 2 ]
grep -q '^1/2 fig04-rings: [0-9.]* s$' "$folder/out"
grep -q '^2 pictures, 0.0 MiB, in ' "$folder/out"
[ ! -e "$folder/index.md" ]
