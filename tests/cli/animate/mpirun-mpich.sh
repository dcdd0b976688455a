# The same by MPICH.
mpi=mpich
. "$SOURCE/tests/cli/animate/mpirun.sh"
