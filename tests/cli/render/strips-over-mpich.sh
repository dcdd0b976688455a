# The same by MPICH, whose launcher names a killed process by its number and machine.
mpi=mpich killed="EXIT CODE: 9"
. "$SOURCE/tests/cli/render/strips-over-ranks.sh"
