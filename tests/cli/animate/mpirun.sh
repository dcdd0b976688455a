# MPI's own launchers: seven processes on however many processors share five frames; the same pictures.
mpi=${mpi-open_mpi}
halflight make rings --size 16 --quiet
halflight render rings.nrrd --size 32x32 --sheet-spacing 4 --print-scene >scene.json
halflight animate scene.json --turntable 5 --quiet -o whole
"$SOURCE/tests/over_ranks.sh" $mpi 7 "$HALFLIGHT" animate scene.json --turntable 5 --quiet --frames-over-ranks -o shared >mpirun.txt 2>&1 ||
  { code=$?; cat mpirun.txt; exit $code; }
ls shared
for frame in whole/*.png; do cmp "$frame" "shared/${frame#whole/}"; done
