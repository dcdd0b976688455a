# A volume that lies in the memory of several processes makes the picture of one process: its bytes, though each
# process reads its own slices alone, and keeps little of the others'. A process that dies ends all, and no picture is left.
# slow: 26 seconds of processor time
mpi=${mpi-open_mpi} killed=${killed-process rank 1} # and what the launcher says of a killed process
run() { "$SOURCE/tests/over_ranks.sh" $mpi "$@" >mpirun.txt 2>&1; }
runs() { run "$@" || { cat mpirun.txt; exit 1; }; } # what must not fail says why it did
run 1 true || [ $? != 77 ] || { cat mpirun.txt; exit 77; }
frame="--size 60x50 --ambient 0.2 --shadow-resolution 64 --shadows hard --threads 1 --quiet"
tool ball 176 ball_176x176x176_uint8.raw
halflight convert ball_176x176x176_uint8.raw ball.nrrd --quiet
halflight render ball.nrrd $frame --print-scene >scene.json
halflight render scene.json --quiet -o whole.npy
# How many bytes each process has read, of files of any kind: a fourth of the volume's 5,451,776, and what it takes to start
# (0.9 to 1.2 million, most under a sanitizer). Half of the volume would be too many.
cat >counted.sh <<'END'
"$@"
code=$?
sed -n 's/rchar: //p' /proc/$$/io >read.${OMPI_COMM_WORLD_RANK-$PMI_RANK}
exit $code
END
runs 4 sh counted.sh "$HALFLIGHT" render ball_176x176x176_uint8.raw $frame --volume-over-ranks -o shared.npy
halflight render ball_176x176x176_uint8.raw $frame -o raw.npy
cmp raw.npy shared.npy
awk '$1 > 3200000 { print FILENAME ": " $1 " bytes" }' read.0 read.1 read.2 read.3
for ranks in 1 3 7; do
  runs $ranks "$HALFLIGHT" render scene.json --quiet --volume-over-ranks --max-memory 14M -o shared.npy
  cmp whole.npy shared.npy && rm shared.npy
done
halflight render scene.json --quiet --sky skyblue:orange -o sky.npy
runs 3 "$HALFLIGHT" render scene.json --quiet --sky skyblue:orange --volume-over-ranks -o shared.npy
cmp sky.npy shared.npy && rm shared.npy sky.npy
# A label map keeps its numbers of 64 bits, of which floats hold 24: bare, shown in part, beside a volume, over it, in a scene.
tool atlas 66 atlas.nrrd
for labels in "atlas.nrrd" "ball.nrrd --labels atlas.nrrd --show 614454278=red,997=green:0.5" \
  "ball.nrrd --mask atlas.nrrd --show 614454277,rest:0.1"; do
  halflight render $labels $frame -o labels.npy
  halflight render $labels $frame --print-scene >labels.json
  runs 3 "$HALFLIGHT" render $labels $frame --volume-over-ranks -o shared.npy
  cmp labels.npy shared.npy && rm shared.npy
  runs 2 "$HALFLIGHT" render labels.json --quiet --volume-over-ranks -o shared.npy
  cmp labels.npy shared.npy && rm shared.npy
done
rm labels.npy
cat >killed.sh <<'END'
if [ "${OMPI_COMM_WORLD_RANK-$PMI_RANK}" = 1 ]; then (sleep 1; kill -KILL $$) & fi
exec "$HALFLIGHT" render ball_176x176x176_uint8.raw --size 900x1600 --sheet-spacing 0.04 --quiet --volume-over-ranks -o shared.npy
END
cat >failing.sh <<'END'
if [ "${OMPI_COMM_WORLD_RANK-$PMI_RANK}" = 2 ]; then limit="--max-memory 100K"; fi
exec "$HALFLIGHT" render ball_176x176x176_uint8.raw --size 60x50 --quiet --volume-over-ranks -o shared.npy $limit
END
# Ranks with another volume, with more volumes, or with another option would wait for each other without end.
tool ball 120 other_120x120x120_uint8.raw
cat >different.sh <<'END'
if [ "${OMPI_COMM_WORLD_RANK-$PMI_RANK}" = 1 ]; then words=$one; fi
exec "$HALFLIGHT" render ${words:-ball_176x176x176_uint8.raw --volume-over-ranks} --size 60x50 --quiet -o shared.npy
END
for one in "other_120x120x120_uint8.raw --volume-over-ranks" "ball_176x176x176_uint8.raw ball.nrrd --volume-over-ranks" \
  "ball_176x176x176_uint8.raw --strips-over-ranks"; do
  export one
  ! run 3 timeout 60 sh different.sh
  grep -o -m 1 "rank 1 has another" mpirun.txt || cat mpirun.txt
done
! run 4 sh killed.sh
grep -o -m 1 "$killed" mpirun.txt
! run 4 sh failing.sh
grep -o -m 1 "rank 2 of 4 has failed and ends them all" mpirun.txt
grep -o -m 1 "out of memory" mpirun.txt
ls *.npy
halflight render ball.nrrd --volume-over-ranks --print-scene 2>&1 || echo $?
env -u OMPI_COMM_WORLD_SIZE -u PMI_SIZE "$HALFLIGHT" render ball.nrrd --volume-over-ranks -o x.png 2>&1 || echo $?
