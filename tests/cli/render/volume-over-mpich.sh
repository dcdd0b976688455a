# The same by MPICH. Its launcher tells of a process that ended badly: the killed one, or one that missed it first.
# slow: 37 seconds of processor time
mpi=mpich killed="BAD TERMINATION"
. "$SOURCE/tests/cli/render/volume-over-ranks.sh"
