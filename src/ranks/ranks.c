/* ranks/ranks.c - see ranks.h, and halflight/ranks.h. */
#define _GNU_SOURCE
#include "ranks/ranks.h"

#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/context.h"
#include "core/memory.h"

/* The greatest number of values or bytes that one call of MPI transfers, because MPI counts by an int. */
enum { MOST_VALUES = 1 << 28 };

/* ---- waiting ---- */

void hl_ranks_pause(int asked) {
  enum { YIELDS = 100, SHORT_PAUSES = 1000, SHORT = 20000, LONG = 100000 }; /* nanoseconds */
  if (asked < YIELDS) sched_yield();
  else nanosleep(&(struct timespec){.tv_nsec = asked < SHORT_PAUSES ? SHORT : LONG}, NULL);
}

void hl_ranks_wait(hl_ranks *ranks, mpi_handle request) {
  int done = 0;
  for (int asked = 0; !done; asked += asked < MOST_VALUES) {
    pthread_mutex_lock(&ranks->calling);
    ranks->mpi.calls->test(&ranks->mpi, &request, &done);
    pthread_mutex_unlock(&ranks->calling);
    if (!done) hl_ranks_pause(asked);
  }
}

/* ---- collectives ---- */

void hl_ranks_barrier(hl_ranks *ranks) {
  mpi_handle request;
  pthread_mutex_lock(&ranks->calling);
  ranks->mpi.calls->barrier(&ranks->mpi, &request);
  pthread_mutex_unlock(&ranks->calling);
  hl_ranks_wait(ranks, request);
}

void hl_ranks_gather(hl_ranks *ranks, const void *from, size_t bytes, void *to) {
  mpi_handle request;
  pthread_mutex_lock(&ranks->calling);
  ranks->mpi.calls->gather_all(&ranks->mpi, from, (int)bytes, to, &request);
  pthread_mutex_unlock(&ranks->calling);
  hl_ranks_wait(ranks, request);
}

int hl_ranks_compare(hl_ranks *ranks, uint64_t number) {
  if (ranks == NULL) return 0;
  hl_ranks_gather(ranks, &number, sizeof number, ranks->numbers);
  for (int rank = 1; rank < ranks->size; rank++)
    if (ranks->numbers[rank] != ranks->numbers[0]) return rank;
  return 0;
}

hl_status hl_ranks_begin_step(hl_ranks *ranks, ranks_step step, const size_t dimension[3], hl_error *error) {
  static const uint64_t prime = 1099511628211u; /* of the hash FNV-1a of 64 bits */
  uint64_t number = (uint64_t)step;
  for (int axis = 0; axis < 3; axis++) number = (number ^ dimension[axis]) * prime;
  int other = hl_ranks_compare(ranks, number);
  if (other == 0) return HL_OK;
  return hl_fail(
      error, HL_ERROR_INPUT,
      "rank %d has another volume than rank 0: give all processes the same options and equal files", other);
}

/* Messages must be shorter than 2^31 bytes; callers send only some megabytes. Messages between two ranks keep
 * their order, so one tag serves all messages. */
void hl_ranks_send(hl_ranks *ranks, const void *from, size_t bytes, void *to, size_t most,
                   mpi_handle *pending) {
  const mpi_calls *calls = ranks->mpi.calls;
  pthread_mutex_lock(&ranks->calling);
  for (int rank = 0; rank < ranks->size; rank++) {
    if (rank == ranks->rank) continue;
    calls->receive(&ranks->mpi, (unsigned char *)to + (size_t)rank * most, (int)most, rank, TAG_POST,
                   &pending[2 * rank]);
    calls->send(&ranks->mpi, from, (int)bytes, rank, TAG_POST, &pending[2 * rank + 1]);
  }
  pthread_mutex_unlock(&ranks->calling);
}

/* Returns whether all requests are done. A request that is done becomes MPI_REQUEST_NULL, and may be tested
 * again. */
static bool all_done(hl_ranks *ranks, mpi_handle *pending) {
  bool all = true;
  pthread_mutex_lock(&ranks->calling);
  for (int i = 0; i < 2 * ranks->size; i++) {
    int done = 0;
    if (i / 2 == ranks->rank) continue;
    ranks->mpi.calls->test(&ranks->mpi, &pending[i], &done);
    all = all && done;
  }
  pthread_mutex_unlock(&ranks->calling);
  return all;
}

void hl_ranks_look(hl_ranks *ranks, mpi_handle *pending) { all_done(ranks, pending); }

void hl_ranks_receive(hl_ranks *ranks, mpi_handle *pending) {
  for (int asked = 0; !all_done(ranks, pending); asked += asked < MOST_VALUES) hl_ranks_pause(asked);
}

void hl_ranks_sum_counts(hl_ranks *ranks, uint64_t *counts, size_t count) {
  mpi_handle request;
  pthread_mutex_lock(&ranks->calling);
  ranks->mpi.calls->sum_counts(&ranks->mpi, counts, (int)count, &request);
  pthread_mutex_unlock(&ranks->calling);
  hl_ranks_wait(ranks, request);
}

void hl_ranks_tell(hl_ranks *ranks, void *bytes, size_t count, int root) {
  for (size_t done = 0; done < count; done += MOST_VALUES) {
    size_t some = count - done < MOST_VALUES ? count - done : MOST_VALUES;
    mpi_handle request;
    pthread_mutex_lock(&ranks->calling);
    ranks->mpi.calls->broadcast(&ranks->mpi, (unsigned char *)bytes + done, (int)some, root, &request);
    pthread_mutex_unlock(&ranks->calling);
    hl_ranks_wait(ranks, request);
  }
}

void hl_ranks_complete(hl_ranks *ranks, void *elements, size_t count, size_t element_bytes) {
  for (int root = 0; root < ranks->size; root++) {
    size_t first = hl_ranks_part(ranks, count, root), end = hl_ranks_part(ranks, count, root + 1);
    hl_ranks_tell(ranks, (unsigned char *)elements + first * element_bytes, (end - first) * element_bytes,
                  root);
  }
}

void hl_ranks_sum(hl_ranks *ranks, float *values, size_t count) {
  for (size_t done = 0; ranks != NULL && values != NULL && done < count; done += MOST_VALUES) {
    size_t some = count - done < MOST_VALUES ? count - done : MOST_VALUES;
    mpi_handle request;
    pthread_mutex_lock(&ranks->calling);
    ranks->mpi.calls->sum_floats(&ranks->mpi, values + done, (int)some, ranks->rank == 0, &request);
    pthread_mutex_unlock(&ranks->calling);
    hl_ranks_wait(ranks, request);
  }
}

/* ---- joining and leaving ---- */

static hl_status start(hl_ranks *ranks, bool alone, hl_error *error) {
  const mpi *mpi = &ranks->mpi;
  int running = 0, given = 0, needed = alone ? MPI_SERIALIZED : MPI_MULTIPLE;
  if (hl_mpi_initialized(mpi, &running) != 0)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s does not tell whether it was started", mpi->name);
  if (!running && !alone)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "hl_ranks_join: MPI is not started: call MPI_Init_thread()");
  if (running)
    needed = MPI_MULTIPLE; /* the caller has started MPI, and may call MPI while a thread of this library
                            * answers requests */
  int result = running ? hl_mpi_query_thread(mpi, &given) : hl_mpi_init_thread(mpi, needed, &given);
  if (result != 0) return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s does not start", mpi->name);
  ranks->started = !running;
  if (given < needed)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "hl_ranks_join: MPI was started without %s",
                   needed == MPI_MULTIPLE ? "MPI_THREAD_MULTIPLE" : "MPI_THREAD_SERIALIZED");
  return HL_OK;
}

static hl_status join(hl_ranks *ranks, void *communicator, hl_error *error) {
  mpi *mpi = &ranks->mpi;
  hl_status status = hl_mpi_load(ranks->context->options.mpi, mpi, error);
  if (status == HL_OK) status = start(ranks, communicator == NULL, error);
  if (status != HL_OK) return status;
  mpi_handle parent = communicator != NULL ? mpi->calls->handle(communicator) : mpi->world;
  if (mpi->calls->duplicate(mpi, parent) != 0 || mpi->calls->rank(mpi, &ranks->rank) != 0 ||
      mpi->calls->size(mpi, &ranks->size) != 0)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s does not tell this process's rank", mpi->name);
  ranks->numbers = hl_allocate(ranks->context, (size_t)ranks->size, sizeof *ranks->numbers);
  return ranks->numbers != NULL ? HL_OK : hl_fail_memory(error, (size_t)ranks->size, "the ranks of a job");
}

static void release(hl_ranks *ranks) {
  hl_release(ranks->context, ranks->numbers);
  pthread_mutex_destroy(&ranks->calling);
  hl_release(ranks->context, ranks);
}

hl_status hl_ranks_join(hl_context *context, void *communicator, hl_ranks **ranks, hl_error *error) {
  if (ranks != NULL) *ranks = NULL;
  if (context == NULL || ranks == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_ranks_join: context and ranks must not be null");
  hl_ranks *made = hl_allocate_zeroed(context, 1, sizeof *made);
  if (made == NULL) return hl_fail_memory(error, sizeof *made, "the ranks of a job");
  made->context = context;
  pthread_mutex_init(&made->calling, NULL);
  hl_status status = join(made, communicator, error);
  if (status == HL_OK) {
    *ranks = made;
    return HL_OK;
  }
  if (made->started) hl_mpi_finalize(&made->mpi);
  release(made);
  return status;
}

void hl_ranks_leave(hl_ranks *ranks) {
  if (ranks == NULL) return;
  if (ranks->context->ranks == ranks) ranks->context->ranks = NULL;
  hl_ranks_barrier(ranks);
  ranks->mpi.calls->free(&ranks->mpi);
  if (ranks->started) hl_mpi_finalize(&ranks->mpi);
  release(ranks);
}

void hl_ranks_abort(hl_ranks *ranks, int exit_code) {
  if (ranks != NULL) ranks->mpi.calls->abort(&ranks->mpi, exit_code);
}

int hl_ranks_rank(const hl_ranks *ranks) { return ranks != NULL ? ranks->rank : 0; }

int hl_ranks_size(const hl_ranks *ranks) { return ranks != NULL ? ranks->size : 1; }

void hl_ranks_hold_volumes(hl_ranks *ranks) {
  if (ranks != NULL) ranks->context->ranks = ranks;
}

void hl_ranks_traffic(const hl_ranks *ranks, uint64_t *bytes, uint64_t *requests, double *seconds) {
  if (bytes != NULL) *bytes = ranks != NULL ? atomic_load(&ranks->bytes) : 0;
  if (requests != NULL) *requests = ranks != NULL ? atomic_load(&ranks->requests) : 0;
  if (seconds != NULL) *seconds = ranks != NULL ? 1e-9 * (double)atomic_load(&ranks->nanoseconds) : 0;
}
