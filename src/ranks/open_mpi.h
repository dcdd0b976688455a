/* ranks/open_mpi.h - the functions of Open MPI's library, loaded when they are asked for.
 *
 * Open MPI's handles are the addresses of objects in its library, and its functions have the types that the
 * MPI standard says (MPI 3.1; the header of Open MPI 4.1). */
#ifndef HL_RANKS_OPEN_MPI_H
#define HL_RANKS_OPEN_MPI_H

#include "core/error.h"

enum {
  OPEN_MPI_SUCCESS = 0,
  OPEN_MPI_SERIALIZED = 2, /* MPI_THREAD_SERIALIZED */
  OPEN_MPI_MULTIPLE = 3,   /* MPI_THREAD_MULTIPLE */
  OPEN_MPI_ANY = -1        /* MPI_ANY_SOURCE */
};

#define OPEN_MPI_IN_PLACE ((void *)1) /* MPI_IN_PLACE */

/* Types of values and the sum, and what MPI calls them. Statuses are null: MPI_STATUS_IGNORE. */
typedef struct open_mpi {
  void *world, *byte, *real, *whole, *sum; /* MPI_COMM_WORLD, MPI_BYTE, MPI_FLOAT, MPI_UINT64_T, MPI_SUM */
  int (*initialized)(int *flag);
  int (*init)(int *count, char ***arguments, int wanted, int *given);
  int (*query_thread)(int *given);
  int (*finalize)(void);
  int (*abort)(void *communicator, int code);
  int (*duplicate)(void *communicator, void **duplicate);
  int (*free)(void **communicator);
  int (*rank)(void *communicator, int *rank);
  int (*size)(void *communicator, int *size);
  int (*send)(const void *from, int count, void *type, int to, int tag, void *communicator, void **request);
  int (*receive)(void *to, int count, void *type, int from, int tag, void *communicator, void **request);
  int (*receive_now)(void *to, int count, void *type, int from, int tag, void *communicator, void *status);
  int (*probe)(int from, int tag, void *communicator, int *flag, void *status);
  int (*test)(void **request, int *flag, void *status);
  int (*barrier)(void *communicator, void **request);
  int (*broadcast)(void *values, int count, void *type, int root, void *communicator, void **request);
  int (*gather_all)(const void *from, int count, void *type, void *to, int received, void *received_type,
                    void *communicator, void **request);
  int (*sum_all)(const void *from, void *to, int count, void *type, void *operation, void *communicator,
                 void **request);
  int (*sum_to)(const void *from, void *to, int count, void *type, void *operation, int root,
                void *communicator, void **request);
} open_mpi;

/* Loads the library, which stays loaded: it may have threads of its own. */
hl_status hl_open_mpi_load(open_mpi *mpi, hl_error *error);

#endif
