#!/bin/sh
# usage: over_ranks.sh RANKS PROGRAM...: runs a program on so many ranks; 77, skipped, where there is no Open MPI.
command -v mpirun >/dev/null || { echo "mpirun is not installed"; exit 77; }
ranks=$1
shift
# Open MPI itself never frees some of its memory, which the address sanitizer would report.
export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0"
exec mpirun --allow-run-as-root --oversubscribe -n "$ranks" "$@"
