#!/bin/sh
# The cookbook's commands run and leave the pictures that its page shows, and the script refuses what it does not know.
# usage: cookbook.sh SOURCE_FOLDER PROGRAM
set -eu
source=$1 program=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$source/scripts/cookbook" --small --program "$program" >"$folder/out"
[ "$(grep -c 'png$\|left out' "$folder/out")" = "$(grep -c '^## ' "$source/docs/cookbook.md")" ] || { cat "$folder/out"; exit 1; }
! "$source/scripts/cookbook" --small --program "$program" --only "no such section" 2>"$folder/err"
grep -q "no such section" "$folder/err"

# Every stored picture is shown by the page.
for picture in "$source"/docs/pictures/cookbook/*.png; do
  grep -q "(pictures/cookbook/$(basename "$picture"))" "$source/docs/cookbook.md" || { echo "$picture: no recipe"; exit 1; }
done
