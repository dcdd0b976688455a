/* ranks/mpi.c - see mpi.h. */
#define _GNU_SOURCE
#include "ranks/mpi.h"

#include <dlfcn.h>
#include <string.h>

static const char *const names[MPI_FUNCTIONS] = {[MPI_INITIALIZED] = "MPI_Initialized",
                                                 [MPI_INIT_THREAD] = "MPI_Init_thread",
                                                 [MPI_QUERY_THREAD] = "MPI_Query_thread",
                                                 [MPI_FINALIZE] = "MPI_Finalize",
                                                 [MPI_ABORT] = "MPI_Abort",
                                                 [MPI_COMM_DUP] = "MPI_Comm_dup",
                                                 [MPI_COMM_FREE] = "MPI_Comm_free",
                                                 [MPI_COMM_RANK] = "MPI_Comm_rank",
                                                 [MPI_COMM_SIZE] = "MPI_Comm_size",
                                                 [MPI_ISEND] = "MPI_Isend",
                                                 [MPI_IRECV] = "MPI_Irecv",
                                                 [MPI_RECV] = "MPI_Recv",
                                                 [MPI_IPROBE] = "MPI_Iprobe",
                                                 [MPI_TEST] = "MPI_Test",
                                                 [MPI_IBARRIER] = "MPI_Ibarrier",
                                                 [MPI_IBCAST] = "MPI_Ibcast",
                                                 [MPI_IALLGATHER] = "MPI_Iallgather",
                                                 [MPI_IALLREDUCE] = "MPI_Iallreduce",
                                                 [MPI_IREDUCE] = "MPI_Ireduce"};

/* ---- loading ---- */

/* Sets the functions and handles. Returns null if the library has all functions and handles, else the name of
 * a missing function or handle. */
static const char *missing_of(const mpi_library *kind, void *library, mpi *mpi) {
  *mpi = (struct mpi){.name = kind->name, .calls = kind->calls};
  for (int n = 0; n < MPI_FUNCTIONS; n++) {
    void *address = dlsym(library, names[n]);
    if (address == NULL) return names[n];
    memcpy(&mpi->function[n], &address, sizeof address);
  }
  return kind->set_handles(library, mpi) ? NULL : "handles of its kind";
}

/* Opens the first file of the given kind that is an MPI library. flags: flags for dlopen(). Symbols become
 * global, because the library's own modules look for them. */
static hl_status open_kind(const mpi_library *kind, int flags, mpi *mpi, hl_error *error) {
  for (int n = 0; n < 2 && kind->files[n] != NULL; n++) {
    void *library = dlopen(kind->files[n], RTLD_NOW | RTLD_GLOBAL | flags);
    const char *missing = library != NULL ? missing_of(kind, library, mpi) : NULL;
    if (library == NULL) hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: %s", kind->name, dlerror());
    else if (missing == NULL) return HL_OK;
    else hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: %s has no %s", kind->name, kind->files[n], missing);
  }
  return HL_ERROR_UNSUPPORTED;
}

hl_status hl_mpi_load(hl_mpi wanted, mpi *mpi, hl_error *error) {
  if (wanted == HL_MPI_OPEN_MPI) return open_kind(&hl_open_mpi, 0, mpi, error);
  if (wanted == HL_MPI_MPICH) return open_kind(&hl_mpich, 0, mpi, error);
  if (open_kind(&hl_open_mpi, RTLD_NOLOAD, mpi, NULL) == HL_OK ||
      open_kind(&hl_mpich, RTLD_NOLOAD, mpi, NULL) == HL_OK ||
      open_kind(&hl_open_mpi, 0, mpi, NULL) == HL_OK || open_kind(&hl_mpich, 0, mpi, NULL) == HL_OK)
    return HL_OK;
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "there is no MPI library: install Open MPI's (%s) or MPICH's (%s)", hl_open_mpi.files[0],
                 hl_mpich.files[0]);
}

/* ---- calls without handles ---- */

int hl_mpi_initialized(const mpi *mpi, int *started) {
  return ((int (*)(int *))mpi->function[MPI_INITIALIZED])(started);
}

int hl_mpi_init_thread(const mpi *mpi, int wanted, int *given) {
  return ((int (*)(int *, char ***, int, int *))mpi->function[MPI_INIT_THREAD])(NULL, NULL, wanted, given);
}

int hl_mpi_query_thread(const mpi *mpi, int *given) {
  return ((int (*)(int *))mpi->function[MPI_QUERY_THREAD])(given);
}

int hl_mpi_finalize(const mpi *mpi) { return ((int (*)(void))mpi->function[MPI_FINALIZE])(); }
