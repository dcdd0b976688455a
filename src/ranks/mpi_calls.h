/* ranks/mpi_calls.h - implements the calls of mpi.h once for both libraries. The file that includes this
 * header defines
 *
 *     MPI_HANDLE        the type of the library's handles
 *     HANDLE(handle)    the member of an mpi_handle with that type
 *     MPI_ANY_SOURCE, MPI_IN_PLACE, MPI_STATUS_IGNORE
 *
 * This header defines `calls`. */

static mpi_handle handle_of(void *communicator) {
  mpi_handle handle;
  HANDLE(handle) = (MPI_HANDLE)(intptr_t)communicator;
  return handle;
}

static int call_abort(const mpi *mpi, int code) {
  typedef int function(MPI_HANDLE, int);
  return ((function *)mpi->function[MPI_ABORT])(HANDLE(mpi->communicator), code);
}

static int call_duplicate(mpi *mpi, mpi_handle parent) {
  typedef int function(MPI_HANDLE, MPI_HANDLE *);
  return ((function *)mpi->function[MPI_COMM_DUP])(HANDLE(parent), &HANDLE(mpi->communicator));
}

static int call_free(mpi *mpi) {
  typedef int function(MPI_HANDLE *);
  return ((function *)mpi->function[MPI_COMM_FREE])(&HANDLE(mpi->communicator));
}

static int call_rank(const mpi *mpi, int *rank) {
  typedef int function(MPI_HANDLE, int *);
  return ((function *)mpi->function[MPI_COMM_RANK])(HANDLE(mpi->communicator), rank);
}

static int call_size(const mpi *mpi, int *size) {
  typedef int function(MPI_HANDLE, int *);
  return ((function *)mpi->function[MPI_COMM_SIZE])(HANDLE(mpi->communicator), size);
}

static int call_send(const mpi *mpi, const void *from, int bytes, int to, int tag, mpi_handle *request) {
  typedef int function(const void *, int, MPI_HANDLE, int, int, MPI_HANDLE, MPI_HANDLE *);
  return ((function *)mpi->function[MPI_ISEND])(from, bytes, HANDLE(mpi->byte), to, tag,
                                                HANDLE(mpi->communicator), &HANDLE(*request));
}

static int call_receive(const mpi *mpi, void *to, int bytes, int from, int tag, mpi_handle *request) {
  typedef int function(void *, int, MPI_HANDLE, int, int, MPI_HANDLE, MPI_HANDLE *);
  return ((function *)mpi->function[MPI_IRECV])(to, bytes, HANDLE(mpi->byte), from, tag,
                                                HANDLE(mpi->communicator), &HANDLE(*request));
}

static int call_receive_now(const mpi *mpi, void *to, int bytes, int tag) {
  typedef int function(void *, int, MPI_HANDLE, int, int, MPI_HANDLE, void *);
  return ((function *)mpi->function[MPI_RECV])(to, bytes, HANDLE(mpi->byte), MPI_ANY_SOURCE, tag,
                                               HANDLE(mpi->communicator), MPI_STATUS_IGNORE);
}

static int call_probe(const mpi *mpi, int tag, int *any) {
  typedef int function(int, int, MPI_HANDLE, int *, void *);
  return ((function *)mpi->function[MPI_IPROBE])(MPI_ANY_SOURCE, tag, HANDLE(mpi->communicator), any,
                                                 MPI_STATUS_IGNORE);
}

static int call_test(const mpi *mpi, mpi_handle *request, int *done) {
  typedef int function(MPI_HANDLE *, int *, void *);
  return ((function *)mpi->function[MPI_TEST])(&HANDLE(*request), done, MPI_STATUS_IGNORE);
}

static int call_barrier(const mpi *mpi, mpi_handle *request) {
  typedef int function(MPI_HANDLE, MPI_HANDLE *);
  return ((function *)mpi->function[MPI_IBARRIER])(HANDLE(mpi->communicator), &HANDLE(*request));
}

static int call_broadcast(const mpi *mpi, void *bytes, int count, int root, mpi_handle *request) {
  typedef int function(void *, int, MPI_HANDLE, int, MPI_HANDLE, MPI_HANDLE *);
  return ((function *)mpi->function[MPI_IBCAST])(bytes, count, HANDLE(mpi->byte), root,
                                                 HANDLE(mpi->communicator), &HANDLE(*request));
}

static int call_gather_all(const mpi *mpi, const void *from, int bytes, void *to, mpi_handle *request) {
  typedef int function(const void *, int, MPI_HANDLE, void *, int, MPI_HANDLE, MPI_HANDLE, MPI_HANDLE *);
  return ((function *)mpi->function[MPI_IALLGATHER])(from, bytes, HANDLE(mpi->byte), to, bytes,
                                                     HANDLE(mpi->byte), HANDLE(mpi->communicator),
                                                     &HANDLE(*request));
}

static int call_sum_counts(const mpi *mpi, uint64_t *counts, int count, mpi_handle *request) {
  typedef int function(const void *, void *, int, MPI_HANDLE, MPI_HANDLE, MPI_HANDLE, MPI_HANDLE *);
  return ((function *)mpi->function[MPI_IALLREDUCE])(MPI_IN_PLACE, counts, count, HANDLE(mpi->whole),
                                                     HANDLE(mpi->sum), HANDLE(mpi->communicator),
                                                     &HANDLE(*request));
}

static int call_sum_floats(const mpi *mpi, float *values, int count, bool first, mpi_handle *request) {
  typedef int function(const void *, void *, int, MPI_HANDLE, MPI_HANDLE, int, MPI_HANDLE, MPI_HANDLE *);
  return ((function *)mpi->function[MPI_IREDUCE])(first ? MPI_IN_PLACE : values, first ? values : NULL, count,
                                                  HANDLE(mpi->real), HANDLE(mpi->sum), 0,
                                                  HANDLE(mpi->communicator), &HANDLE(*request));
}

static const mpi_calls calls = {handle_of,        call_abort,      call_duplicate,  call_free,
                                call_rank,        call_size,       call_send,       call_receive,
                                call_receive_now, call_probe,      call_test,       call_barrier,
                                call_broadcast,   call_gather_all, call_sum_counts, call_sum_floats};
