/* ranks/mpi.h - declares the calls of MPI that ranks need. The library, Open MPI's or MPICH's, is loaded when
 * ranks are asked for.
 *
 * The two libraries differ in their handles and constants. Handles of Open MPI are addresses of objects;
 * handles of MPICH, and of libraries that share its binary interface (Intel MPI, MVAPICH), are numbers. By
 * the MPI standard (3.1), a call does the same in both libraries. Therefore each library has a table of calls
 * of its own (mpi_calls.h). A call returns 0 (MPI_SUCCESS) or the number of an error. */
#ifndef HL_RANKS_MPI_H
#define HL_RANKS_MPI_H

#include <halflight/context.h>
#include <stdbool.h>

#include "core/error.h"

/* MPI's handle of an object: a communicator, a request, a type of values, or an operation. */
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

/* The calls of MPI that take handles. Calls that set a request return immediately, and test() finds out
 * whether the request is done. */
typedef struct mpi_calls {
  mpi_handle (*handle)(void *communicator); /* converts the argument of hl_ranks_join() */
  int (*abort)(const mpi *mpi, int code);
  int (*duplicate)(mpi *mpi, mpi_handle parent); /* sets mpi->communicator to a duplicate of the parent */
  int (*free)(mpi *mpi);                         /* releases mpi->communicator */
  int (*rank)(const mpi *mpi, int *rank);
  int (*size)(const mpi *mpi, int *size);
  int (*send)(const mpi *mpi, const void *from, int bytes, int to, int tag, mpi_handle *request);
  int (*receive)(const mpi *mpi, void *to, int bytes, int from, int tag, mpi_handle *request);
  int (*receive_now)(const mpi *mpi, void *to, int bytes, int tag); /* receives from any rank */
  int (*probe)(const mpi *mpi, int tag, int *any);                  /* looks for a message from any rank */
  int (*test)(const mpi *mpi, mpi_handle *request, int *done);
  int (*barrier)(const mpi *mpi, mpi_handle *request);
  int (*broadcast)(const mpi *mpi, void *bytes, int count, int root, mpi_handle *request);
  int (*gather_all)(const mpi *mpi, const void *from, int bytes, void *to, mpi_handle *request);
  /* Sums in place; all ranks get the sums. */
  int (*sum_counts)(const mpi *mpi, uint64_t *counts, int count, mpi_handle *request);
  /* Sums arrays over all ranks, in place. Only rank 0 gets the sums. first: whether this is rank 0. */
  int (*sum_floats)(const mpi *mpi, float *values, int count, bool first, mpi_handle *request);
} mpi_calls;

/* A loaded MPI library. The library is never unloaded, because it may have threads of its own. */
struct mpi {
  const char *name; /* the library's name: "Open MPI" or "MPICH" */
  const mpi_calls *calls;
  void (*function[MPI_FUNCTIONS])(void);
  mpi_handle world, byte, real, whole, sum; /* the handles of MPI_COMM_WORLD, MPI_BYTE, MPI_FLOAT,
                                             * MPI_UINT64_T and MPI_SUM */
  mpi_handle communicator;                  /* owned; a duplicate of the parent's communicator; duplicate()
                                             * makes it, and free() frees it */
};

/* A library's properties that are known before it is loaded. */
typedef struct mpi_library {
  const char *name;
  const char *files[2]; /* file names by which the system's loader finds the library; the second name may be
                         * null */
  const mpi_calls *calls;
  /* Sets the handles. library: the result of dlopen(). Returns false if the file is no library of this
   * kind. */
  bool (*set_handles)(void *library, mpi *mpi);
} mpi_library;

extern const mpi_library hl_open_mpi, hl_mpich;

/* Loads the wanted library. HL_MPI_AUTO takes the library that the process has loaded already, else Open
 * MPI's, else MPICH's. */
hl_status hl_mpi_load(hl_mpi wanted, mpi *mpi, hl_error *error);

/* The values of MPI_THREAD_SERIALIZED and MPI_THREAD_MULTIPLE in both libraries. */
enum { MPI_SERIALIZED = 2, MPI_MULTIPLE = 3 };

/* The calls that take no handles. */
int hl_mpi_initialized(const mpi *mpi, int *started);
int hl_mpi_init_thread(const mpi *mpi, int wanted, int *given);
int hl_mpi_query_thread(const mpi *mpi, int *given);
int hl_mpi_finalize(const mpi *mpi);

#endif
