/* ranks/blocks.c - see blocks.h. */
#define _GNU_SOURCE
#include "ranks/blocks.h"
#include "platform/clock.h"

#include <signal.h>
#include <string.h>
#include <sys/prctl.h>

#include "core/memory.h"

/* FETCHES: the greatest number of threads of a rank that fetch at the same time. REPLIES: the greatest number
 * of answers of a rank that may be under way. */
enum { FETCHES = 8, REPLIES = 8 };

/* A request for a part of another rank's block. */
typedef struct block_request {
  uint64_t id, from, tag; /* id: number of the array of blocks; from: the rank that sends the request; tag:
                           * the tag of the reply */
  hl_box box;             /* the wanted part, in indices of the block of the rank that is asked */
} block_request;

/* An answer that has been sent, and that may not have arrived yet. */
typedef struct block_reply {
  unsigned char *bytes; /* a part of memory that the hl_blocks owns */
  mpi_handle request;
  bool sent; /* whether an answer was sent with this reply; the answer may not have arrived yet */
} block_reply;

/* The state of one thread's fetch. */
typedef struct block_fetch {
  hl_box *parts;           /* [ranks]; the part that this fetch asks from each rank */
  mpi_handle *pending;     /* [ranks]; MPI's requests */
  bool *waited;            /* [ranks]; whether the request in `pending` must still be waited for */
  unsigned char *received; /* [shape.most][element_bytes] */
  int number;
  bool busy; /* read and written with `lock` held */
} block_fetch;

struct hl_blocks {
  hl_ranks *ranks;
  hl_blocks *next; /* the next array of blocks in the server's list */
  uint64_t id;     /* number of this array of blocks, the same on all ranks */
  hl_blocks_shape shape;
  hl_block_source source;
  void *memory;  /* owned; holds all arrays */
  hl_box *boxes; /* [ranks]; the box that each rank holds */
  block_fetch fetch[FETCHES];
  pthread_mutex_t lock;
  pthread_cond_t freed;       /* signalled when a fetch ends */
  block_reply reply[REPLIES]; /* the answers, which are used in turn by the thread that holds
                               * ranks->calling */
  int turn;
};

struct hl_block_server {
  pthread_t thread;
  atomic_bool stopped;
  hl_blocks *first; /* read and written with ranks->calling held */
  uint64_t made;    /* number of block arrays made so far */
  bool running;
};

bool hl_boxes_meet(const hl_box *a, const hl_box *b, hl_box *both) {
  bool any = true;
  for (int axis = 0; axis < 3; axis++) {
    uint64_t begin = a->begin[axis] > b->begin[axis] ? a->begin[axis] : b->begin[axis];
    uint64_t end_a = a->begin[axis] + a->count[axis], end_b = b->begin[axis] + b->count[axis];
    uint64_t end = end_a < end_b ? end_a : end_b;
    any = any && begin < end;
    both->begin[axis] = begin;
    both->count[axis] = begin < end ? end - begin : 0;
  }
  return any;
}

static size_t elements_of(const hl_box *box) { return box->count[0] * box->count[1] * box->count[2]; }

hl_ranks *hl_blocks_ranks(const hl_blocks *blocks) { return blocks->ranks; }

const hl_block_source *hl_blocks_source(const hl_blocks *blocks) { return &blocks->source; }

/* ---- answering ---- */

static hl_blocks *blocks_with(const struct hl_block_server *server, uint64_t id) {
  hl_blocks *blocks = server->first;
  while (blocks != NULL && blocks->id != id) blocks = blocks->next;
  return blocks;
}

/* Sends the elements that a request wants. The caller must hold the lock ranks->calling. */
static void answer(hl_ranks *ranks, const block_request *asked) {
  hl_blocks *blocks = blocks_with(ranks->server, asked->id);
  /* An array of blocks is missing only if this rank has failed, so that the job is about to end. */
  if (blocks == NULL) return;
  block_reply *reply = &blocks->reply[blocks->turn++ % REPLIES];
  for (int done = !reply->sent; !done;) ranks->mpi.calls->test(&ranks->mpi, &reply->request, &done);
  blocks->source.copy(blocks->source.data, &asked->box, reply->bytes);
  size_t bytes = elements_of(&asked->box) * blocks->shape.element_bytes;
  ranks->mpi.calls->send(&ranks->mpi, reply->bytes, (int)bytes, (int)asked->from, (int)asked->tag,
                         &reply->request);
  reply->sent = true;
}

/* Answers one waiting request. Returns false if no request is waiting. */
static bool serve(hl_ranks *ranks) {
  int any = 0;
  block_request asked;
  pthread_mutex_lock(&ranks->calling);
  ranks->mpi.calls->probe(&ranks->mpi, TAG_REQUEST, &any);
  if (any) {
    ranks->mpi.calls->receive_now(&ranks->mpi, &asked, (int)sizeof asked, TAG_REQUEST);
    answer(ranks, &asked);
  }
  pthread_mutex_unlock(&ranks->calling);
  return any;
}

static void *run_server(void *data) {
  hl_ranks *ranks = data;
  prctl(PR_SET_TIMERSLACK, 1000UL, 0UL, 0UL, 0UL); /* without this call, each pause of the thread may last 50
                                                    * microseconds longer */
  for (int asked = 0; !atomic_load(&ranks->server->stopped);) {
    asked = serve(ranks) ? 0 : asked + (asked < INT32_MAX);
    if (asked > 0) hl_ranks_pause(asked);
  }
  return NULL;
}

/* ---- sharing ---- */

static hl_status start_server(hl_ranks *ranks, hl_error *error) {
  if (ranks->server == NULL) ranks->server = hl_allocate_zeroed(ranks->context, 1, sizeof *ranks->server);
  struct hl_block_server *server = ranks->server;
  if (server == NULL) return hl_fail_memory(error, sizeof *server, "the ranks' blocks");
  if (server->running) return HL_OK;
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before); /* signals go to the program's own threads */
  int failed = pthread_create(&server->thread, NULL, run_server, ranks);
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  if (failed) return hl_fail(error, HL_ERROR_MEMORY, "the system starts no thread to answer other ranks");
  server->running = true;
  return HL_OK;
}

static void stop_server(hl_ranks *ranks) {
  struct hl_block_server *server = ranks->server;
  atomic_store(&server->stopped, true);
  pthread_join(server->thread, NULL);
  atomic_store(&server->stopped, false);
  server->running = false;
}

static void lay_out(hl_blocks *blocks, hl_layout *layout) {
  size_t ranks = (size_t)blocks->ranks->size;
  blocks->boxes = hl_layout_take(layout, ranks, sizeof *blocks->boxes);
  for (int n = 0; n < FETCHES; n++) {
    block_fetch *fetch = &blocks->fetch[n];
    fetch->number = n;
    fetch->parts = hl_layout_take(layout, ranks, sizeof *fetch->parts);
    fetch->pending = hl_layout_take(layout, ranks, sizeof *fetch->pending);
    fetch->waited = hl_layout_take(layout, ranks, sizeof *fetch->waited);
    fetch->received = hl_layout_take(layout, blocks->shape.most, blocks->shape.element_bytes);
  }
  for (int n = 0; n < REPLIES; n++)
    blocks->reply[n].bytes = hl_layout_take(layout, blocks->shape.most, blocks->shape.element_bytes);
}

static hl_status fail_box(const hl_blocks *blocks, int rank, const char *what, hl_error *error) {
  const hl_box *box = &blocks->boxes[rank];
  return hl_fail(error, HL_ERROR_ARGUMENT,
                 "rank %d holds %llu x %llu x %llu voxels from %llu, %llu, %llu on: %s", rank,
                 (unsigned long long)box->count[0], (unsigned long long)box->count[1],
                 (unsigned long long)box->count[2], (unsigned long long)box->begin[0],
                 (unsigned long long)box->begin[1], (unsigned long long)box->begin[2], what);
}

/* Checks that the boxes of all ranks fill the array: they lie within the array, they do not overlap, and
 * their numbers of elements sum to the array's number of elements. */
static hl_status check_boxes(const hl_blocks *blocks, hl_error *error) {
  const size_t *n = blocks->shape.dimension;
  size_t elements = 0;
  hl_box both;
  for (int rank = 0; rank < blocks->ranks->size; rank++) {
    const hl_box *box = &blocks->boxes[rank];
    for (int axis = 0; axis < 3; axis++)
      if (box->count[axis] > n[axis] || box->begin[axis] > n[axis] - box->count[axis])
        return fail_box(blocks, rank, "they reach beyond the volume", error);
    for (int other = 0; other < rank; other++)
      if (hl_boxes_meet(box, &blocks->boxes[other], &both))
        return fail_box(blocks, rank, "another rank holds some of them, too", error);
    elements += elements_of(box);
  }
  if (elements == n[0] * n[1] * n[2]) return HL_OK;
  return hl_fail(error, HL_ERROR_ARGUMENT, "the ranks hold %zu of the volume's %zu voxels", elements,
                 n[0] * n[1] * n[2]);
}

static void set_first(hl_ranks *ranks, hl_blocks *blocks, bool listed) {
  pthread_mutex_lock(&ranks->calling);
  hl_blocks **place = &ranks->server->first;
  if (listed) {
    blocks->id = ranks->server->made++;
    blocks->next = *place;
    *place = blocks;
  } else {
    while (*place != NULL && *place != blocks) place = &(*place)->next;
    if (*place == blocks) *place = blocks->next;
  }
  pthread_mutex_unlock(&ranks->calling);
}

static hl_status make_blocks(hl_ranks *ranks, const hl_blocks_shape *shape, const hl_block_source *source,
                             hl_blocks **blocks, hl_error *error) {
  hl_blocks *made = *blocks = hl_allocate_zeroed(ranks->context, 1, sizeof *made);
  if (made == NULL) return hl_fail_memory(error, sizeof *made, "the ranks' blocks");
  made->ranks = ranks;
  pthread_mutex_init(&made->lock, NULL);
  pthread_cond_init(&made->freed, NULL);
  made->shape = *shape;
  made->source = *source;
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, ranks->context)) lay_out(made, &layout);
  made->memory = layout.base;
  if (made->memory == NULL) return hl_fail_memory(error, layout.bytes, "the ranks' blocks");
  return start_server(ranks, error);
}

hl_status hl_blocks_share(hl_ranks *ranks, const hl_blocks_shape *shape, const hl_block_source *source,
                          hl_blocks **blocks, hl_error *error) {
  hl_status status = make_blocks(ranks, shape, source, blocks, error);
  if (status == HL_OK) status = hl_ranks_begin_step(ranks, RANKS_SHARE_VOLUME, shape->dimension, error);
  if (status == HL_OK) {
    set_first(ranks, *blocks, true); /* other ranks may ask for parts as soon as the gathering has ended */
    hl_ranks_gather(ranks, &source->box, sizeof source->box, (*blocks)->boxes);
    status = check_boxes(*blocks, error);
  }
  if (status == HL_OK) return HL_OK;
  hl_blocks_release(*blocks, false);
  *blocks = NULL;
  return status;
}

void hl_blocks_release(hl_blocks *blocks, bool together) {
  if (blocks == NULL) return;
  hl_ranks *ranks = blocks->ranks;
  if (together) hl_ranks_barrier(ranks);
  if (ranks->server != NULL) set_first(ranks, blocks, false);
  for (int n = 0; n < REPLIES; n++)
    if (blocks->reply[n].sent) hl_ranks_wait(ranks, blocks->reply[n].request);
  if (ranks->server != NULL && ranks->server->first == NULL) {
    if (ranks->server->running) stop_server(ranks);
    hl_release(ranks->context, ranks->server);
    ranks->server = NULL;
  }
  pthread_mutex_destroy(&blocks->lock);
  pthread_cond_destroy(&blocks->freed);
  hl_release(ranks->context, blocks->memory);
  hl_release(ranks->context, blocks);
}

/* ---- fetching ---- */

/* Reserves one of the fetches for the calling thread, and waits until a fetch is free. */
static block_fetch *begin_fetch(hl_blocks *blocks) {
  block_fetch *fetch = NULL;
  pthread_mutex_lock(&blocks->lock);
  while (fetch == NULL) {
    for (int n = 0; n < FETCHES && fetch == NULL; n++)
      if (!blocks->fetch[n].busy) fetch = &blocks->fetch[n];
    if (fetch == NULL) pthread_cond_wait(&blocks->freed, &blocks->lock);
  }
  fetch->busy = true;
  pthread_mutex_unlock(&blocks->lock);
  return fetch;
}

static void end_fetch(hl_blocks *blocks, block_fetch *fetch) {
  pthread_mutex_lock(&blocks->lock);
  fetch->busy = false;
  pthread_cond_signal(&blocks->freed);
  pthread_mutex_unlock(&blocks->lock);
}

/* Asks a rank for a part of its block. The tag of the answer differs between fetches and between arrays, and
 * stays within MPI's limit of 32767. */
static void ask(hl_blocks *blocks, block_fetch *fetch, int rank, unsigned char *to) {
  enum { MOST_ARRAYS = 4000 };
  hl_ranks *ranks = blocks->ranks;
  int tag = TAG_REPLY + (int)(blocks->id % MOST_ARRAYS) * FETCHES + fetch->number;
  const block_request wanted = {blocks->id, (uint64_t)ranks->rank, (uint64_t)tag, fetch->parts[rank]};
  mpi_handle sent;
  size_t bytes = elements_of(&wanted.box) * blocks->shape.element_bytes;
  pthread_mutex_lock(&ranks->calling);
  ranks->mpi.calls->receive(&ranks->mpi, to, (int)bytes, rank, tag, &fetch->pending[rank]);
  ranks->mpi.calls->send(&ranks->mpi, &wanted, (int)sizeof wanted, rank, TAG_REQUEST, &sent);
  pthread_mutex_unlock(&ranks->calling);
  hl_ranks_wait(ranks, sent);
  fetch->waited[rank] = true;
  atomic_fetch_add(&ranks->bytes, bytes);
  atomic_fetch_add(&ranks->requests, 1);
}

/* Copies a received part to its place in the caller's array. */
static void place(const hl_blocks *blocks, const hl_box *box, const hl_box *part, const unsigned char *from,
                  unsigned char *to, const size_t step[2]) {
  size_t bytes = blocks->shape.element_bytes, row = part->count[0] * bytes;
  to += (part->begin[2] - box->begin[2]) * step[1] + (part->begin[1] - box->begin[1]) * step[0] +
        (part->begin[0] - box->begin[0]) * bytes;
  for (uint64_t k = 0; k < part->count[2]; k++)
    for (uint64_t j = 0; j < part->count[1]; j++, from += row)
      memcpy(to + k * step[1] + j * step[0], from, row);
}

/* The address in the caller's array at which a part can be received without a copy. Null if the part's rows
 * and slices are not adjacent in the caller's array. */
static unsigned char *place_of(const hl_blocks *blocks, const hl_box *box, const hl_box *part,
                               unsigned char *to, const size_t step[2]) {
  bool whole = part->count[0] * blocks->shape.element_bytes == step[0] && part->count[1] * step[0] == step[1];
  return whole ? to + (part->begin[2] - box->begin[2]) * step[1] : NULL;
}

void hl_blocks_fetch(hl_blocks *blocks, const hl_box *box, unsigned char *to, size_t row_bytes,
                     size_t slice_bytes) {
  hl_ranks *ranks = blocks->ranks;
  const size_t step[2] = {row_bytes, slice_bytes};
  int64_t before = hl_clock_nanoseconds();
  block_fetch *fetch = begin_fetch(blocks);
  unsigned char *next = fetch->received;
  for (int rank = 0; rank < ranks->size; rank++) {
    hl_box *part = &fetch->parts[rank];
    fetch->waited[rank] = false;
    if (!hl_boxes_meet(box, &blocks->boxes[rank], part)) continue;
    unsigned char *at_once = place_of(blocks, box, part, to, step);
    if (rank != ranks->rank) ask(blocks, fetch, rank, at_once != NULL ? at_once : next);
    else blocks->source.copy(blocks->source.data, part, at_once != NULL ? at_once : next);
    next += elements_of(part) * blocks->shape.element_bytes;
  }
  next = fetch->received;
  for (int rank = 0; rank < ranks->size; rank++) {
    const hl_box *part = &fetch->parts[rank];
    if (elements_of(part) == 0) continue;
    if (fetch->waited[rank]) hl_ranks_wait(ranks, fetch->pending[rank]);
    if (place_of(blocks, box, part, to, step) == NULL) place(blocks, box, part, next, to, step);
    next += elements_of(part) * blocks->shape.element_bytes;
  }
  atomic_fetch_add(&ranks->nanoseconds, (uint64_t)(hl_clock_nanoseconds() - before));
  end_fetch(blocks, fetch);
}
