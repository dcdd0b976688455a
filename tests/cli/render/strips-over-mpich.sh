# The same by MPICH. Its launcher tells of a process that ended badly: the killed one, or one that missed it first.
# slow: 9 seconds of processor time
mpi=mpich killed="BAD TERMINATION"
. "$SOURCE/tests/cli/render/strips-over-ranks.sh"
