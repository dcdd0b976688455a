# Open MPI's own launcher: seven processes on however many processors share five frames; the same pictures.
command -v mpirun >/dev/null || { echo "mpirun is not installed"; exit 77; }
halflight make rings --size 16 --quiet
halflight render rings.nrrd --size 32x32 --sheet-spacing 4 --print-scene >scene.json
halflight animate scene.json --turntable 5 --quiet -o whole
mpirun --allow-run-as-root --oversubscribe -n 7 "$HALFLIGHT" animate scene.json --turntable 5 --quiet --frames-over-ranks -o shared 2>&1
ls shared
for frame in whole/*.png; do cmp "$frame" "shared/${frame#whole/}"; done
