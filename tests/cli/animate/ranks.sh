# Processes of a launcher share the frames: each by its rank in the environment, and the film's frames are those of one run.
halflight make rings --size 16 --quiet
halflight render rings.nrrd --size 32x32 --sheet-spacing 4 --print-scene >scene.json
whole() { halflight animate scene.json --turntable 5 --quiet -o whole; }
whole
rank() { env -u OMPI_COMM_WORLD_RANK -u PMI_RANK -u SLURM_PROCID "$@" "$HALFLIGHT" animate scene.json --turntable 5 --quiet \
  -o ranks --frames-over-ranks 2>&1 || echo $?; }
rank SLURM_PROCID=2 SLURM_NTASKS=3
ls ranks
rank PMI_RANK=0 PMI_SIZE=3
rank OMPI_COMM_WORLD_RANK=1 OMPI_COMM_WORLD_SIZE=3
ls ranks
for frame in whole/*.png; do cmp "$frame" "ranks/${frame#whole/}"; done
rank
rank PMI_RANK=3 PMI_SIZE=3
rank PMI_RANK=1x PMI_SIZE=3
rank PMI_RANK=0 PMI_SIZE=3 OMPI_COMM_WORLD_RANK=-1 OMPI_COMM_WORLD_SIZE=
halflight animate scene.json --turntable 5 --frames-over-ranks --part 1/2 -o both 2>&1 || echo $?
ls
