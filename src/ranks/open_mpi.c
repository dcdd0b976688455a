/* ranks/open_mpi.c - defines Open MPI's handles and constants. The source is the header of Open MPI 4.1,
 * whose interface Open MPI 5 shares. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stddef.h>

#include "ranks/mpi.h"

#define MPI_HANDLE        void *
#define HANDLE(handle)    ((handle).address)
#define MPI_ANY_SOURCE    (-1)
#define MPI_IN_PLACE      ((void *)1)
#define MPI_STATUS_IGNORE NULL
#include "ranks/mpi_calls.h"

static bool set_handles(void *library, mpi *mpi) {
  mpi->world.address = dlsym(library, "ompi_mpi_comm_world");
  mpi->byte.address = dlsym(library, "ompi_mpi_byte");
  mpi->real.address = dlsym(library, "ompi_mpi_float");
  mpi->whole.address = dlsym(library, "ompi_mpi_uint64_t");
  mpi->sum.address = dlsym(library, "ompi_mpi_op_sum");
  return mpi->world.address != NULL && mpi->byte.address != NULL && mpi->real.address != NULL &&
         mpi->whole.address != NULL && mpi->sum.address != NULL;
}

const mpi_library hl_open_mpi = {"Open MPI", {"libmpi.so.40", NULL}, &calls, set_handles};
