# The same by MPICH.
mpi=mpich
. "$SOURCE/tests/cli/render/strips-over-ranks.sh"
