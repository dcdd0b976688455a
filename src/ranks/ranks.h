/* ranks/ranks.h - the inside of hl_ranks: MPI's calls one at a time, and what all ranks do together.
 *
 * Threads take turns (`calling`), and nothing waits within MPI: a rank that waits for others (for the end of
 * a collective, for voxels) asks again and again, and between two questions other threads make calls. So it
 * answers the others meanwhile, and no two ranks wait for each other. MPI_THREAD_SERIALIZED suffices where no
 * one else calls MPI. */
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
  bool started;                          /* MPI was started here, and is ended here */
  pthread_mutex_t calling;               /* held during each call of MPI */
  struct hl_block_server *server;        /* owned (blocks.h); null: no blocks are shared */
  atomic_uint_least64_t bytes, requests; /* that were got from others */
  atomic_uint_least64_t nanoseconds;     /* that threads waited for them */
};

/* Waits until a request is done, without keeping other threads from calling MPI. */
void hl_ranks_wait(hl_ranks *ranks, mpi_handle request);

/* Lets a moment pass between two questions, longer ones after many. */
void hl_ranks_pause(int asked);

/* Tags of messages. Those of replies to requests (blocks.c) go on from the last one. */
enum { TAG_REQUEST = 1, TAG_POST = 2, TAG_REPLY = 3 };

/* ---- collectives ---- */

void hl_ranks_barrier(hl_ranks *ranks);

/* from: `bytes` bytes of this rank. to: [size][bytes], everyone's. */
void hl_ranks_gather(hl_ranks *ranks, const void *from, size_t bytes, void *to);

/* Begins to give all other ranks some bytes, and to get theirs, which may be more or fewer, each at most
 * `most`: to: [size][most]; the piece of this rank itself is left as it is. pending: [2 size], of the caller.
 * All ranks begin this in the same order; arrays stay as they are until hl_ranks_receive(). */
void hl_ranks_send(hl_ranks *ranks, const void *from, size_t bytes, void *to, size_t most,
                   mpi_handle *pending);
/* Lets it get on. */
void hl_ranks_look(hl_ranks *ranks, mpi_handle *pending);
/* Waits until all is done. */
void hl_ranks_receive(hl_ranks *ranks, mpi_handle *pending);

/* Gives one rank's bytes to all others. */
void hl_ranks_tell(hl_ranks *ranks, void *bytes, size_t count, int root);

/* Adds up everyone's counts; all get the sums. */
void hl_ranks_sum_counts(hl_ranks *ranks, uint64_t *counts, size_t count);

/* Everyone has computed a part of the elements of an array, those from number hl_ranks_part(n) up to those of
 * the next rank; then all have all. element_bytes: of each. */
void hl_ranks_complete(hl_ranks *ranks, void *elements, size_t count, size_t element_bytes);

/* The first of `count` elements that is a rank's part, or `count` for the rank after the last. */
static inline size_t hl_ranks_part(const hl_ranks *ranks, size_t count, int rank) {
  return (size_t)((unsigned __int128)count * (unsigned)rank / (unsigned)ranks->size);
}

#endif
