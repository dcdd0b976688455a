/* ranks/mpich.c - defines MPICH's handles and constants. The source is the header of MPICH 4.0. MPICH's
 * binary interface has not changed since 3.1, and Intel MPI and MVAPICH share it. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stddef.h>

#include "ranks/mpi.h"

#define MPI_HANDLE        int
#define HANDLE(handle)    ((handle).number)
#define MPI_ANY_SOURCE    (-2)
#define MPI_IN_PLACE      ((void *)-1)
#define MPI_STATUS_IGNORE ((void *)1)
#include "ranks/mpi_calls.h"

/* The library of an old Open MPI, which has other handles, is also named libmpi.so.12. */
static bool set_handles(void *library, mpi *mpi) {
  mpi->world.number = 0x44000000;
  mpi->byte.number = 0x4c00010d;
  mpi->real.number = 0x4c00040a;
  mpi->whole.number = 0x4c00083e;
  mpi->sum.number = 0x58000003;
  return dlsym(library, "ompi_mpi_comm_world") == NULL;
}

/* The common name of the library, and the name in Debian's libmpich12. */
const mpi_library hl_mpich = {"MPICH", {"libmpi.so.12", "libmpich.so.12"}, &calls, set_handles};
