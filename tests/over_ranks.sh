#!/bin/sh
# usage: over_ranks.sh open_mpi|mpich RANKS PROGRAM...: runs a program on so many ranks by that launcher; exits with 77,
# skipped, where it is not installed.
case $1 in
  open_mpi) says="Open MPI" names="mpirun.openmpi mpirun" ;;
  mpich) says=HYDRA names="mpirun.mpich mpiexec.hydra mpirun" ;;
  *) sed -n '2,3s/^# //p' "$0" >&2; exit 2 ;;
esac
for name in $names; do
  launcher=$(command -v $name) && "$launcher" --version 2>&1 | grep -q "$says" && break
  launcher=
done
[ -n "$launcher" ] || { echo "the launcher of $1 is not installed"; exit 77; }
options=
[ "$1" = mpich ] || options="--allow-run-as-root --oversubscribe"
ranks=$2
shift 2
# Open MPI itself never frees some of its memory, which the address sanitizer would report.
export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0"
# shellcheck disable=SC2086 # several options
exec "$launcher" $options -n "$ranks" "$@"
