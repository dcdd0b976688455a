# The same by MPICH.
mpi=mpich
. "$SOURCE/tests/cli/render/volume-over-ranks.sh"
