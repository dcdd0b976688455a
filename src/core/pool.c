/* core/pool.c - the thread team. Jobs come in quick succession (two a sheet), so workers spin a
 * while for the next one before they sleep; with more threads than processors they sleep at once. */
#define _GNU_SOURCE
#include "core/pool.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

#include "core/context.h"
#include "core/cpu.h"
#include "core/memory.h"

enum { MAXIMUM_THREADS = 256, SPINS = 4000 };

typedef struct worker {
  hl_pool *pool;
  int number; /* 1 .. threads-1 */
  pthread_t thread;
} worker;

struct hl_pool {
  hl_context *context;
  int threads;
  int spins;
  worker *workers; /* owned; [threads]; entry 0 (the caller) unused */
  int started;     /* threads running, the caller included */
  /* the job, written before generation is raised */
  void (*function)(void *, size_t, int);
  void *data;
  size_t count;
  atomic_size_t next;        /* the next index to hand out */
  atomic_uint generation;    /* raised for each job */
  atomic_int working;        /* workers that have not finished the job */
  atomic_bool stop;
  pthread_mutex_t mutex;
  pthread_cond_t wake;       /* generation or stop changed */
  pthread_cond_t done;       /* working fell to 0 */
};

static inline void relax(void) {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

static void work(hl_pool *pool, int number) {
  for (;;) {
    size_t index = atomic_fetch_add(&pool->next, 1);
    if (index >= pool->count) return;
    pool->function(pool->data, index, number);
  }
}

/* Waits until generation differs from seen; false when the pool stops. */
static bool wait_for_job(hl_pool *pool, unsigned seen) {
  for (int spin = 0; spin < pool->spins; spin++) {
    if (atomic_load(&pool->generation) != seen) return !atomic_load(&pool->stop);
    relax();
  }
  pthread_mutex_lock(&pool->mutex);
  while (atomic_load(&pool->generation) == seen) pthread_cond_wait(&pool->wake, &pool->mutex);
  pthread_mutex_unlock(&pool->mutex);
  return !atomic_load(&pool->stop);
}

static void *worker_main(void *argument) {
  worker *self = argument;
  hl_pool *pool = self->pool;
  for (unsigned seen = 0; wait_for_job(pool, seen); seen++) {
    work(pool, self->number);
    if (atomic_fetch_sub(&pool->working, 1) == 1) {
      pthread_mutex_lock(&pool->mutex);
      pthread_cond_signal(&pool->done);
      pthread_mutex_unlock(&pool->mutex);
    }
  }
  return NULL;
}

static void announce(hl_pool *pool) {
  pthread_mutex_lock(&pool->mutex);
  atomic_fetch_add(&pool->generation, 1);
  pthread_cond_broadcast(&pool->wake);
  pthread_mutex_unlock(&pool->mutex);
}

static void wait_for_workers(hl_pool *pool) {
  for (int spin = 0; spin < pool->spins; spin++) {
    if (atomic_load(&pool->working) == 0) return;
    relax();
  }
  pthread_mutex_lock(&pool->mutex);
  while (atomic_load(&pool->working) != 0) pthread_cond_wait(&pool->done, &pool->mutex);
  pthread_mutex_unlock(&pool->mutex);
}

void hl_pool_run(hl_pool *pool, size_t count, void (*function)(void *, size_t, int), void *data) {
  if (pool->threads == 1 || count <= 1) {
    for (size_t index = 0; index < count; index++) function(data, index, 0);
    return;
  }
  pool->function = function;
  pool->data = data;
  pool->count = count;
  atomic_store(&pool->next, 0);
  atomic_store(&pool->working, pool->threads - 1);
  announce(pool);
  work(pool, 0);
  wait_for_workers(pool);
}

int hl_pool_threads(const hl_pool *pool) { return pool->threads; }

hl_status hl_pool_create(hl_context *context, int threads, hl_pool **pool, hl_error *error) {
  *pool = NULL;
  if (threads <= 0) threads = hl_cpu_count();
  if (threads > MAXIMUM_THREADS) threads = MAXIMUM_THREADS;
  hl_pool *made = hl_allocate_zeroed(context, 1, sizeof *made);
  worker *workers = hl_allocate_zeroed(context, (size_t)threads, sizeof *workers);
  if (made == NULL || workers == NULL) {
    hl_release(context, workers);
    hl_release(context, made);
    return hl_fail_memory(error, sizeof *made, "the thread pool");
  }
  made->context = context;
  made->threads = threads;
  made->spins = threads <= hl_cpu_count() ? SPINS : 0;
  made->workers = workers;
  pthread_mutex_init(&made->mutex, NULL);
  pthread_cond_init(&made->wake, NULL);
  pthread_cond_init(&made->done, NULL);
  for (made->started = 1; made->started < threads; made->started++) {
    worker *self = &workers[made->started];
    self->pool = made;
    self->number = made->started;
    if (pthread_create(&self->thread, NULL, worker_main, self) != 0) {
      hl_pool_destroy(made);
      return hl_fail(error, HL_ERROR_IO, "the system would not start %d threads: ask for fewer", threads);
    }
  }
  *pool = made;
  return HL_OK;
}

void hl_pool_destroy(hl_pool *pool) {
  if (pool == NULL) return;
  hl_context *context = pool->context;
  atomic_store(&pool->stop, true);
  announce(pool);
  for (int i = 1; i < pool->started; i++) pthread_join(pool->workers[i].thread, NULL);
  pthread_cond_destroy(&pool->done);
  pthread_cond_destroy(&pool->wake);
  pthread_mutex_destroy(&pool->mutex);
  hl_release(context, pool->workers);
  hl_release(context, pool);
}
