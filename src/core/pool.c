/* core/pool.c - the thread team. Jobs come in quick succession (two a sheet), so workers spin a while for the
 * next one before they sleep; with more threads than processors they sleep at once.
 *
 * A job is one 64-bit ticket: generation, count, next index. Indices are claimed by compare-and-swap, and the
 * caller waits for claimed indices only, never for a worker that the system has not woken: on a busy machine it
 * does the work alone. A job's description stays in its slot (by the generation's parity) while an index of it is
 * claimed, since a later job of the same parity cannot start before that. */
#define _GNU_SOURCE
#include "core/pool.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "core/context.h"
#include "core/cpu.h"
#include "core/memory.h"

enum { MAXIMUM_THREADS = 256, SPINS = 4000 };

/* Between two questions whether to stop, while a job runs: far less than a person notices, far more than asking takes. */
static const int64_t NANOSECONDS_BETWEEN_QUESTIONS = 2000000;

typedef struct worker {
  hl_pool *pool;
  int number; /* 1 .. threads-1 */
  pthread_t thread;
} worker;

typedef struct job {
  void (*function)(void *, size_t, int);
  void *data;
  size_t base;           /* of the ticket's indices */
  atomic_size_t done;    /* indices finished */
} job;

enum { INDEX_BITS = 20 }; /* of a ticket's index and count; longer jobs run in parts */
static const uint64_t INDEX_MASK = ((uint64_t)1 << INDEX_BITS) - 1;

struct hl_pool {
  hl_context *context;
  int threads;
  int spins;
  worker *workers; /* owned; [threads]; entry 0 (the caller) unused */
  int started;     /* threads running, the caller included */
  pid_t process;   /* whose threads they are */
  job jobs[2];
  atomic_uint_least64_t ticket; /* generation << 40 | count << 20 | next index */
  atomic_bool stop;
  atomic_bool cancelled;        /* indices are passed over */
  int64_t asked;                /* when the calling thread last asked, nanoseconds */
  atomic_int sleepers;
  pthread_mutex_t mutex;
  pthread_cond_t wake;       /* ticket or stop changed */
};

static inline void relax(void) {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

static bool has_work(uint64_t ticket) { return (ticket & INDEX_MASK) < (ticket >> INDEX_BITS & INDEX_MASK); }

static int64_t now_nanoseconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

bool hl_pool_cancelled(hl_pool *pool) {
  if (atomic_load(&pool->cancelled)) return true;
  pool->asked = now_nanoseconds();
  if (!hl_cancelled(pool->context)) return false;
  atomic_store(&pool->cancelled, true);
  return true;
}

bool hl_pool_stops(hl_pool *pool, int worker) {
  bool cancelled = atomic_load_explicit(&pool->cancelled, memory_order_relaxed);
  if (cancelled || worker != 0 || now_nanoseconds() - pool->asked < NANOSECONDS_BETWEEN_QUESTIONS) return cancelled;
  return hl_pool_cancelled(pool);
}

void hl_pool_resume(hl_pool *pool) { atomic_store(&pool->cancelled, false); }

/* Works on whatever is to be done until nothing is. */
static void work(hl_pool *pool, int number) {
  uint64_t ticket = atomic_load(&pool->ticket);
  while (has_work(ticket)) {
    if (!atomic_compare_exchange_weak(&pool->ticket, &ticket, ticket + 1)) continue;
    job *job = &pool->jobs[ticket >> (2 * INDEX_BITS) & 1];
    if (!hl_pool_stops(pool, number)) job->function(job->data, job->base + (size_t)(ticket & INDEX_MASK), number);
    atomic_fetch_add(&job->done, 1);
    ticket = atomic_load(&pool->ticket);
  }
}

static void sleep_until_work(hl_pool *pool) {
  pthread_mutex_lock(&pool->mutex);
  atomic_fetch_add(&pool->sleepers, 1);
  while (!has_work(atomic_load(&pool->ticket)) && !atomic_load(&pool->stop)) pthread_cond_wait(&pool->wake, &pool->mutex);
  atomic_fetch_sub(&pool->sleepers, 1);
  pthread_mutex_unlock(&pool->mutex);
}

static void *worker_main(void *argument) {
  worker *self = argument;
  hl_pool *pool = self->pool;
  while (!atomic_load(&pool->stop)) {
    work(pool, self->number);
    int spin = 0;
    for (; spin < pool->spins && !has_work(atomic_load(&pool->ticket)); spin++) relax();
    if (spin == pool->spins) sleep_until_work(pool);
  }
  return NULL;
}

static void wake_sleepers(hl_pool *pool) {
  if (atomic_load(&pool->sleepers) == 0) return;
  pthread_mutex_lock(&pool->mutex);
  pthread_cond_broadcast(&pool->wake);
  pthread_mutex_unlock(&pool->mutex);
}

/* Waits for indices that others have claimed: spinning, then letting them run. */
static void wait_until_done(hl_pool *pool, const job *job, size_t count) {
  for (int spin = 0; atomic_load(&job->done) < count; spin++) {
    if (spin < pool->spins) relax();
    else sched_yield();
  }
}

static void run_part(hl_pool *pool, size_t base, size_t count, void (*function)(void *, size_t, int), void *data) {
  uint64_t generation = (atomic_load(&pool->ticket) >> (2 * INDEX_BITS)) + 1;
  job *job = &pool->jobs[generation & 1];
  job->function = function;
  job->data = data;
  job->base = base;
  atomic_store(&job->done, 0);
  atomic_store(&pool->ticket, generation << (2 * INDEX_BITS) | (uint64_t)count << INDEX_BITS);
  wake_sleepers(pool);
  work(pool, 0);
  wait_until_done(pool, job, count);
}

void hl_pool_run(hl_pool *pool, size_t count, void (*function)(void *, size_t, int), void *data) {
  if (pool->threads == 1 || count <= 1) {
    for (size_t index = 0; index < count && !hl_pool_stops(pool, 0); index++) function(data, index, 0);
    return;
  }
  for (size_t base = 0; base < count; base += INDEX_MASK)
    run_part(pool, base, count - base < INDEX_MASK ? count - base : INDEX_MASK, function, data);
}

enum { FLOATS_A_TASK = 1 << 16, BYTES_A_TASK = 1 << 18 };

typedef struct fill_job {
  float *floats;
  size_t count;
  float value;
} fill_job;

static void fill_part(void *data, size_t index, int worker) {
  (void)worker;
  const fill_job *job = data;
  size_t first = index * FLOATS_A_TASK, end = job->count - first < FLOATS_A_TASK ? job->count : first + FLOATS_A_TASK;
  for (size_t i = first; i < end; i++) job->floats[i] = job->value;
}

void hl_pool_fill(hl_pool *pool, float *floats, size_t count, float value) {
  fill_job job = {floats, count, value};
  hl_pool_run(pool, (count + FLOATS_A_TASK - 1) / FLOATS_A_TASK, fill_part, &job);
}

typedef struct set_job {
  unsigned char *memory;
  size_t bytes;
  int value;
} set_job;

static void set_part(void *data, size_t index, int worker) {
  (void)worker;
  const set_job *job = data;
  size_t first = index * BYTES_A_TASK, left = job->bytes - first;
  memset(job->memory + first, job->value, left < BYTES_A_TASK ? left : BYTES_A_TASK);
}

void hl_pool_set(hl_pool *pool, void *memory, size_t bytes, int value) {
  set_job job = {memory, bytes, value};
  hl_pool_run(pool, (bytes + BYTES_A_TASK - 1) / BYTES_A_TASK, set_part, &job);
}

void hl_pool_clear(hl_pool *pool, void *memory, size_t bytes) { hl_pool_set(pool, memory, bytes, 0); }

int hl_pool_threads(const hl_pool *pool) { return pool->threads; }

bool hl_pool_is_own(const hl_pool *pool) { return pool->process == getpid(); }

/* Threads inherit the mask of the one that starts them. */
static void start_workers(hl_pool *pool) {
  sigset_t all, own;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &own);
  for (pool->started = 1; pool->started < pool->threads; pool->started++) {
    worker *self = &pool->workers[pool->started];
    self->pool = pool;
    self->number = pool->started;
    if (pthread_create(&self->thread, NULL, worker_main, self) != 0) break;
  }
  pthread_sigmask(SIG_SETMASK, &own, NULL);
}

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
  made->process = getpid();
  start_workers(made);
  if (made->started < threads)
    hl_log(context, HL_LOG_WARNING, "the system starts only %d of %d threads: it will take longer", made->started, threads);
  made->threads = made->started;
  *pool = made;
  return HL_OK;
}

static void stop_workers(hl_pool *pool) {
  atomic_store(&pool->stop, true);
  pthread_mutex_lock(&pool->mutex);
  pthread_cond_broadcast(&pool->wake);
  pthread_mutex_unlock(&pool->mutex);
  for (int i = 1; i < pool->started; i++) pthread_join(pool->workers[i].thread, NULL);
  pthread_cond_destroy(&pool->wake);
  pthread_mutex_destroy(&pool->mutex);
}

void hl_pool_destroy(hl_pool *pool) {
  if (pool == NULL) return;
  if (hl_pool_is_own(pool)) stop_workers(pool);
  hl_release(pool->context, pool->workers);
  hl_release(pool->context, pool);
}
