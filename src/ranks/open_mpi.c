/* ranks/open_mpi.c - see open_mpi.h. */
#define _GNU_SOURCE
#include "ranks/open_mpi.h"

#include <dlfcn.h>
#include <stddef.h>
#include <string.h>

/* The library that Debian's libopenmpi3 has; versions 4 and 5 of Open MPI share its interface. */
static const char library_name[] = "libmpi.so.40";

typedef struct wanted_symbol {
  const char *name;
  size_t place; /* of the pointer in open_mpi, bytes */
} wanted_symbol;

static const wanted_symbol wanted[] = {
    {"ompi_mpi_comm_world", offsetof(open_mpi, world)},
    {"ompi_mpi_byte", offsetof(open_mpi, byte)},
    {"ompi_mpi_float", offsetof(open_mpi, real)},
    {"ompi_mpi_uint64_t", offsetof(open_mpi, whole)},
    {"ompi_mpi_op_sum", offsetof(open_mpi, sum)},
    {"MPI_Initialized", offsetof(open_mpi, initialized)},
    {"MPI_Init_thread", offsetof(open_mpi, init)},
    {"MPI_Query_thread", offsetof(open_mpi, query_thread)},
    {"MPI_Finalize", offsetof(open_mpi, finalize)},
    {"MPI_Abort", offsetof(open_mpi, abort)},
    {"MPI_Comm_dup", offsetof(open_mpi, duplicate)},
    {"MPI_Comm_free", offsetof(open_mpi, free)},
    {"MPI_Comm_rank", offsetof(open_mpi, rank)},
    {"MPI_Comm_size", offsetof(open_mpi, size)},
    {"MPI_Isend", offsetof(open_mpi, send)},
    {"MPI_Irecv", offsetof(open_mpi, receive)},
    {"MPI_Recv", offsetof(open_mpi, receive_now)},
    {"MPI_Iprobe", offsetof(open_mpi, probe)},
    {"MPI_Test", offsetof(open_mpi, test)},
    {"MPI_Ibarrier", offsetof(open_mpi, barrier)},
    {"MPI_Ibcast", offsetof(open_mpi, broadcast)},
    {"MPI_Iallgather", offsetof(open_mpi, gather_all)},
    {"MPI_Iallreduce", offsetof(open_mpi, sum_all)},
    {"MPI_Ireduce", offsetof(open_mpi, sum_to)},
};

hl_status hl_open_mpi_load(open_mpi *mpi, hl_error *error) {
  void *library = dlopen(library_name, RTLD_NOW | RTLD_GLOBAL); /* its own modules look for its symbols */
  if (library == NULL) return hl_fail(error, HL_ERROR_UNSUPPORTED, "Open MPI: %s", dlerror());
  for (size_t n = 0; n < sizeof wanted / sizeof *wanted; n++) {
    void *address = dlsym(library, wanted[n].name);
    if (address == NULL)
      return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: it has no %s: it is not Open MPI's", library_name,
                     wanted[n].name);
    memcpy((char *)mpi + wanted[n].place, &address, sizeof address);
  }
  return HL_OK;
}
