/* ranks/mpi.h - the calls of MPI that ranks need, by Open MPI's library or MPICH's, loaded when it is asked
 * for.
 *
 * The two differ in what handles are: in Open MPI addresses of objects of its library; in MPICH, and in the
 * libraries that share its binary interface (Intel MPI, MVAPICH), numbers. They differ in constants, too.
 * What a call does is the same: the MPI standard (3.1) says it. So each library has its table of calls
 * (mpi_calls.h). Calls return 0 (MPI_SUCCESS) or an error's number. */
#ifndef HL_RANKS_MPI_H
#define HL_RANKS_MPI_H

#include <halflight/context.h>
#include <stdbool.h>

#include "core/error.h"

/* What MPI knows a thing by: a communicator, a request, a type of values, an operation. */
typedef union mpi_handle {
  void *address; /* Open MPI */
  int number;    /* MPICH */
} mpi_handle;

/* Functions of the library. */
typedef enum mpi_function {
  MPI_INITIALIZED,
  MPI_INIT_THREAD,
  MPI_QUERY_THREAD,
  MPI_FINALIZE,
  MPI_ABORT,
  MPI_COMM_DUP,
  MPI_COMM_FREE,
  MPI_COMM_RANK,
  MPI_COMM_SIZE,
  MPI_ISEND,
  MPI_IRECV,
  MPI_RECV,
  MPI_IPROBE,
  MPI_TEST,
  MPI_IBARRIER,
  MPI_IBCAST,
  MPI_IALLGATHER,
  MPI_IALLREDUCE,
  MPI_IREDUCE,
  MPI_FUNCTIONS
} mpi_function;

typedef struct mpi mpi;

/* Calls with handles. Those with a request return at once; test() tells when they are done. */
typedef struct mpi_calls {
  mpi_handle (*handle)(void *communicator); /* of hl_ranks_join()'s argument */
  int (*abort)(const mpi *mpi, int code);
  int (*duplicate)(mpi *mpi, mpi_handle parent); /* sets mpi->communicator */
  int (*free)(mpi *mpi);                         /* the communicator */
  int (*rank)(const mpi *mpi, int *rank);
  int (*size)(const mpi *mpi, int *size);
  int (*send)(const mpi *mpi, const void *from, int bytes, int to, int tag, mpi_handle *request);
  int (*receive)(const mpi *mpi, void *to, int bytes, int from, int tag, mpi_handle *request);
  int (*receive_now)(const mpi *mpi, void *to, int bytes, int tag); /* from any rank */
  int (*probe)(const mpi *mpi, int tag, int *any);                  /* from any rank */
  int (*test)(const mpi *mpi, mpi_handle *request, int *done);
  int (*barrier)(const mpi *mpi, mpi_handle *request);
  int (*broadcast)(const mpi *mpi, void *bytes, int count, int root, mpi_handle *request);
  int (*gather_all)(const mpi *mpi, const void *from, int bytes, void *to, mpi_handle *request);
  int (*sum_counts)(const mpi *mpi, uint64_t *counts, int count, mpi_handle *request); /* in place, for all */
  int (*sum_floats)(const mpi *mpi, float *values, int count, bool first, mpi_handle *request); /* in place,
                                      for rank 0 alone; first: whether this is rank 0 */
} mpi_calls;

/* A library that was loaded; it stays so, as it may have threads of its own. */
struct mpi {
  const char *name; /* of the library: "Open MPI", "MPICH" */
  const mpi_calls *calls;
  void (*function[MPI_FUNCTIONS])(void);
  mpi_handle world, byte, real, whole, sum; /* MPI_COMM_WORLD, MPI_BYTE, MPI_FLOAT, MPI_UINT64_T, MPI_SUM */
  mpi_handle communicator;                  /* owned: a duplicate, between duplicate() and free() */
};

/* What is known of a library before it is loaded. */
typedef struct mpi_library {
  const char *name;
  const char *files[2]; /* names that the system's loader knows; the second may be null */
  const mpi_calls *calls;
  /* Sets the handles. library: of dlopen(). False: it is no library of this kind. */
  bool (*set_handles)(void *library, mpi *mpi);
} mpi_library;

extern const mpi_library hl_open_mpi, hl_mpich;

/* Loads the library that is wanted. HL_MPI_AUTO: the one that the process has loaded already, else Open
 * MPI's, else MPICH's. */
hl_status hl_mpi_load(hl_mpi wanted, mpi *mpi, hl_error *error);

/* MPI_THREAD_SERIALIZED and MPI_THREAD_MULTIPLE, in both libraries. */
enum { MPI_SERIALIZED = 2, MPI_MULTIPLE = 3 };

/* Calls without handles. */
int hl_mpi_initialized(const mpi *mpi, int *started);
int hl_mpi_init_thread(const mpi *mpi, int wanted, int *given);
int hl_mpi_query_thread(const mpi *mpi, int *given);
int hl_mpi_finalize(const mpi *mpi);

#endif
