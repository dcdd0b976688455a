/* volume/io/parallel.c - reads the parts of a volume on all threads. The reading also reports progress,
 * handles cancellation, and returns the error of the failed part with the lowest index. */
#include "volume/io/parallel.h"

#include <pthread.h>
#include <stdatomic.h>

#include "core/context.h"

typedef struct parts {
  hl_context *context;
  size_t count;
  hl_part_reader read;
  void *data;
  pthread_mutex_t lock;
  atomic_size_t done, failed; /* done: number of parts that have been read; failed: the lowest index of a part
                               * that failed, SIZE_MAX if no part has failed */
  hl_status status;           /* status of part `failed` */
  hl_error error;
} parts;

static void keep_error(parts *p, size_t index, hl_status status, const hl_error *error) {
  pthread_mutex_lock(&p->lock);
  if (index < atomic_load(&p->failed)) {
    atomic_store(&p->failed, index);
    p->status = status;
    p->error = *error;
  }
  pthread_mutex_unlock(&p->lock);
}

static void read_part(void *data, size_t index, int worker) {
  parts *p = data;
  hl_error error = {0};
  if (index > atomic_load(&p->failed)) return;
  hl_status status = p->read(p->data, index, worker, &error);
  if (status != HL_OK) keep_error(p, index, status, &error);
  size_t done = atomic_fetch_add(&p->done, 1) + 1;
  if (worker == 0) hl_progress(p->context, "load", (double)done / (double)p->count);
}

hl_status hl_parallel_read(hl_context *context, hl_pool *pool, const char *path, size_t count,
                           hl_part_reader read, void *data, hl_error *error) {
  parts p = {.context = context, .count = count, .read = read, .data = data};
  atomic_init(&p.done, 0);
  atomic_init(&p.failed, SIZE_MAX);
  pthread_mutex_init(&p.lock, NULL);
  hl_pool_run(pool, count, read_part, &p);
  pthread_mutex_destroy(&p.lock);
  if (hl_pool_cancelled(pool)) return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", path);
  if (atomic_load(&p.failed) == SIZE_MAX) return HL_OK;
  if (error != NULL) *error = p.error;
  return p.status;
}
