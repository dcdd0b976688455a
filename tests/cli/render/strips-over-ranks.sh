# Processes of an MPI launcher make one picture together: its bytes. One that fails ends all, and no picture is left.
# slow: 6 seconds of processor time
mpi=${mpi-open_mpi} killed=${killed-process rank 1} # and what the launcher says of a killed process
run() { "$SOURCE/tests/over_ranks.sh" $mpi "$@" >mpirun.txt 2>&1; }
runs() { run "$@" || { cat mpirun.txt; exit 1; }; } # what must not fail says why it did
run 1 true || [ $? != 77 ] || { cat mpirun.txt; exit 77; }
halflight make rings --size 24 --quiet
halflight render rings.nrrd --size 60x100 --sheet-spacing 2 --quiet -o whole.npy
for ranks in 1 4 8; do
  runs $ranks "$HALFLIGHT" render rings.nrrd --size 60x100 --sheet-spacing 2 --quiet --strips-over-ranks -o shared.npy
  cmp whole.npy shared.npy && rm shared.npy
done
# The light of a sky, which processes find in slabs of cells, on a surface, too.
sky="--size 60x50 --sheet-spacing 2 --sky skyblue:orange --iso 0.3 --quiet"
halflight render rings.nrrd $sky -o sky.npy
for ranks in 3 7; do
  runs $ranks "$HALFLIGHT" render rings.nrrd $sky --strips-over-ranks -o shared.npy
  cmp sky.npy shared.npy && rm shared.npy
done
cat >failing.sh <<'END'
if [ "${OMPI_COMM_WORLD_RANK-$PMI_RANK}" = 2 ]; then limit="--max-memory 100K"; fi
exec "$HALFLIGHT" render rings.nrrd --size 60x100 --sheet-spacing 2 --quiet --strips-over-ranks -o shared.npy $limit
END
cat >killed.sh <<'END'
if [ "${OMPI_COMM_WORLD_RANK-$PMI_RANK}" = 1 ]; then (sleep 0.7; kill -KILL $$) & fi
exec "$HALFLIGHT" render rings.nrrd --size 900x1600 --sheet-spacing 0.04 --quiet --strips-over-ranks -o shared.npy
END
# Ranks that make different pictures, as with an older copy of a file on one machine, would wait for each other without end;
# equal files may have different names.
halflight make rings --size 20 --quiet -o older.nrrd
cp rings.nrrd "copy of rings.nrrd"
cat >different.sh <<'END'
if [ "${OMPI_COMM_WORLD_RANK-$PMI_RANK}" = 1 ]; then input=$one options=$more; fi
exec "$HALFLIGHT" render "${input:-rings.nrrd}" --size 60x100 --sheet-spacing 2 --quiet --strips-over-ranks -o "${options:-shared.npy}"
END
for one in older.nrrd missing.nrrd; do
  export one
  ! run 3 timeout 60 sh different.sh
  grep -o -m 1 "rank 1 has another scene or other voxels than rank 0\|missing.nrrd: cannot open" mpirun.txt
done
export one="copy of rings.nrrd"
runs 3 sh different.sh
cmp whole.npy shared.npy && rm shared.npy
export one= more=none/shared.npy
! run 3 timeout 60 sh different.sh
grep -o -m 1 "its folder 'none' cannot be written\|rank 1 of 3 has failed" mpirun.txt
# A rank whose command line is wrong, or that lacks the memory to join, fails before it has joined the others.
cat >wrong.sh <<'END'
if [ "${OMPI_COMM_WORLD_RANK-$PMI_RANK}" = 1 ]; then more=$wrong; fi
exec "$HALFLIGHT" render rings.nrrd --size 60x100 --sheet-spacing 2 --quiet --strips-over-ranks -o shared.npy $more
END
for wrong in "--shadows nonsense" --strip-over-ranks --layers "--max-memory 1"; do
  export wrong
  ! run 3 timeout 60 sh wrong.sh
  grep -o -m 1 "rank 1 of 3 has failed and ends them all" mpirun.txt || { echo "$wrong"; cat mpirun.txt; }
done
# A rank that lacks the option never joins; the others wait for it no longer than the variable says.
cat >lacking.sh <<'END'
case "${OMPI_COMM_WORLD_RANK-$PMI_RANK}" in 1) more="-o alone.npy" ;; *) more="--strips-over-ranks -o shared.npy" ;; esac
exec "$HALFLIGHT" render rings.nrrd --size 60x100 --sheet-spacing 2 --quiet $more
END
export HALFLIGHT_JOIN_SECONDS=2
! run 3 timeout 60 sh lacking.sh
grep -o -m 1 "not all processes have joined within 2 seconds: give all of them --strips-over-ranks" mpirun.txt || cat mpirun.txt
HALFLIGHT_JOIN_SECONDS=soon
! run 1 "$HALFLIGHT" render rings.nrrd --quiet --strips-over-ranks -o shared.npy
grep -o -m 1 "HALFLIGHT_JOIN_SECONDS must be a whole number of seconds above 0" mpirun.txt
unset HALFLIGHT_JOIN_SECONDS
! run 4 sh failing.sh
grep -o -m 1 "rank 2 of 4 has failed and ends them all" mpirun.txt
! run 4 sh killed.sh
grep -o -m 1 "$killed" mpirun.txt
test ! -e shared.npy && echo "no picture"
halflight render rings.nrrd --strips-over-ranks --layers -o x.exr 2>&1 || echo $?
env -u OMPI_COMM_WORLD_SIZE -u PMI_SIZE "$HALFLIGHT" render rings.nrrd --strips-over-ranks -o x.png 2>&1 || echo $?
# A process whose library does not know the other processes that the launcher speaks of.
variable=PMI
[ $mpi = mpich ] || variable=OMPI_COMM_WORLD
env ${variable}_RANK=0 ${variable}_SIZE=3 "$HALFLIGHT" render rings.nrrd --strips-over-ranks -o x.png >alone.txt 2>&1 || echo $?
grep -o -m 1 "SIZE is 3, but MPI's processes are 1: the library and the launcher belong to different MPIs" alone.txt
