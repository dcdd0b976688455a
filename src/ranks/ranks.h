/* ranks/ranks.h - defines the members of hl_ranks, makes MPI's calls one at a time, and implements the
 * collective operations.
 *
 * Threads take turns in calling MPI (`calling`), and no call waits within MPI. A rank that waits for other
 * ranks (for the end of a collective operation, or for voxels) tests its requests again and again. Between
 * two tests, other threads of the rank can call MPI. So the rank answers other ranks while it waits, and no
 * two ranks block each other. MPI_THREAD_SERIALIZED suffices if nobody else in the process calls MPI. */
#ifndef HL_RANKS_RANKS_H
#define HL_RANKS_RANKS_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

#include <halflight/ranks.h>

#include "ranks/mpi.h"

struct hl_ranks {
  hl_context *context;
  mpi mpi;
  int rank, size;
  bool started;                          /* whether hl_ranks_join() started MPI; if so, this library must also
                                          * end MPI */
  uint64_t *numbers;                     /* owned; [size], memory of hl_ranks_compare() */
  pthread_mutex_t calling;               /* held during each call of MPI */
  struct hl_block_server *server;        /* owned (blocks.h); null if no blocks are shared */
  atomic_uint_least64_t bytes, requests; /* the bytes that were received from other ranks, and the requests
                                          * for them */
  atomic_uint_least64_t nanoseconds;     /* the sum of the times during which threads waited for bytes from
                                          * other ranks */
};

/* Waits until a request is done. While the function waits, other threads can call MPI. */
void hl_ranks_wait(hl_ranks *ranks, mpi_handle request);

/* Pauses between two tests of a request. asked: the number of tests so far; the more tests, the longer the
 * pause. */
void hl_ranks_pause(int asked);

/* Tags of messages. The tags of replies to requests (blocks.c) begin at TAG_REPLY. */
enum { TAG_REQUEST = 1, TAG_POST = 2, TAG_REPLY = 3 };

/* ---- collectives ---- */

void hl_ranks_barrier(hl_ranks *ranks);

/* Gathers bytes from every rank on all ranks. from: this rank's bytes; each rank sends the same number of
 * bytes. to: [size][bytes]. */
void hl_ranks_gather(hl_ranks *ranks, const void *from, size_t bytes, void *to);

/* The steps that ranks take together before their scenes are compared. A rank with another file or another
 * option would take part in another collective than the other ranks. */
typedef enum ranks_step { RANKS_SHARE_VOLUME = 1, RANKS_COPY_LABELS } ranks_step;

/* Fails on all ranks if they do not all begin the same step, with an array of the same dimensions. */
hl_status hl_ranks_begin_step(hl_ranks *ranks, ranks_step step, const size_t dimension[3], hl_error *error);

/* Begins to send this rank's bytes to all other ranks, and to receive the bytes of the other ranks. Ranks may
 * send different numbers of bytes, each at most `most`. to: [size][most]; this rank's own row is not changed.
 * pending: [2 size], memory of the caller. All ranks begin these exchanges in the same order. The arrays must
 * not change before hl_ranks_receive() returns. */
void hl_ranks_send(hl_ranks *ranks, const void *from, size_t bytes, void *to, size_t most,
                   mpi_handle *pending);
/* Lets an exchange that was begun make progress. */
void hl_ranks_look(hl_ranks *ranks, mpi_handle *pending);
/* Waits until an exchange is complete. */
void hl_ranks_receive(hl_ranks *ranks, mpi_handle *pending);

/* Sends one rank's bytes to all other ranks. */
void hl_ranks_tell(hl_ranks *ranks, void *bytes, size_t count, int root);

/* Adds up the counts of all ranks; all ranks get the sums. */
void hl_ranks_sum_counts(hl_ranks *ranks, uint64_t *counts, size_t count);

/* Completes an array of which each rank has computed its part (hl_ranks_part()): afterwards all ranks have
 * all elements. element_bytes: bytes of one element. */
void hl_ranks_complete(hl_ranks *ranks, void *elements, size_t count, size_t element_bytes);

/* The first element of a rank's part, when `count` elements are divided among the ranks. The part ends where
 * the next rank's part begins. For rank number `size`, the result is `count`. */
static inline size_t hl_ranks_part(const hl_ranks *ranks, size_t count, int rank) {
  return (size_t)((unsigned __int128)count * (unsigned)rank / (unsigned)ranks->size);
}

#endif
