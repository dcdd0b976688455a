/* core/pool.c - runs a team of threads that run jobs together. Jobs follow each other quickly (two jobs for
 * each sheet). Therefore a worker without work spins for a while before it sleeps. If the pool has more
 * threads than the machine has processors, the worker sleeps at once.
 *
 * Each thread owns a share: a run of consecutive indices of the job. In all jobs of the same length a thread
 * has the same run, so that the thread uses the same memory in each job. A share is one 64-bit word on its
 * own cache line: generation, end, next index. The owner claims indices from one end by compare-and-swap. A
 * thread whose own share is empty claims indices from the other end of another thread's share. Every second
 * thread begins with the last index of its share. Therefore two threads with neighbouring shares meet near
 * the border of their shares, and a thread mostly claims the same indices of the other thread's share as in
 * the previous job. No thread waits for a worker that the system has not woken yet, so that on a busy machine
 * the caller does all the work. Jobs alternate between two slots, by the parity of their generation. A job's
 * description stays in its slot until all workers have reported the indices that they claimed; only then can
 * a later job of the same parity start.
 *
 * An offer is a second job with shares of its own (hl_pool_offer()). When the current job has no index left,
 * a worker claims one of the offer's indices, and then looks for a new job. Since the caller has further jobs
 * to begin, the caller claims none of the offer's indices before it finishes the offer. */
#define _GNU_SOURCE
#include "core/pool.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "platform/clock.h"
#include "platform/processors.h"

enum { MAXIMUM_THREADS = 256, SPINS = 4000 };

/* The time between two calls of the cancel callback while a job runs. The time between two calls is much less
 * than a user notices, and much more than a call takes. */
static const int64_t NANOSECONDS_BETWEEN_QUESTIONS = 2000000;
/* The clock is read again after MOST_UNREAD calls at most. The clock is read earlier if MOST_UNREAD calls
 * could take longer than NANOSECONDS_BETWEEN_READINGS. */
static const int64_t NANOSECONDS_BETWEEN_READINGS = 50000;
enum { MOST_UNREAD = 15 };

typedef struct worker {
  hl_pool *pool;
  int number; /* number of the worker, from 1 to threads - 1; the caller is worker 0 */
  pthread_t thread;
} worker;

typedef struct job {
  void (*function)(void *, size_t, int);
  void *data;
  size_t base;                     /* the index of the job to which index 0 of the shares belongs */
  _Alignas(64) atomic_size_t done; /* the number of indices that workers have reported as finished */
} job;

enum {
  INDEX_BITS = 20
}; /* number of bits of an index in a share's `range`; a job with more indices runs in pieces */
static const uint64_t INDEX_MASK = ((uint64_t)1 << INDEX_BITS) - 1, ONE_OF_END = (uint64_t)1 << INDEX_BITS;

typedef struct share {
  /* three numbers in one 64-bit word: generation << 40 | end << 20 | next index */
  _Alignas(64) atomic_uint_least64_t range;
} share;

typedef struct offer {
  share *shares; /* [share_count]; the shares of the offer, which follow the pool's own shares in memory */
  size_t count;  /* the number of indices of the offered job; 0 if no job is offered */
  job job;
} offer;

struct hl_pool {
  hl_context *context;
  int threads;
  int spins;
  worker *workers; /* owned; [threads]; entry 0, which stands for the caller, is unused */
  int started;     /* number of running threads, including the caller */
  pid_t process;   /* id of the process that started the threads */
  share *shares;   /* owned; [2][share_count]; first the shares of the jobs, then the shares of the offer */
  /* requested number of threads, which is also the number of shares; some of the threads may not have
   * started */
  int share_count;
  job jobs[2];
  offer offer;
  atomic_uint_least64_t generation; /* number of the last job whose shares are filled */
  atomic_bool stop;
  atomic_bool cancelled; /* whether the remaining indices are skipped, because the cancel callback asked to
                          * stop */
  atomic_int sleepers;
  pthread_mutex_t mutex;
  pthread_cond_t wake; /* signalled when `generation` or `stop` has changed */
  /* Only the calling thread uses the following members. */
  _Alignas(64) int64_t asked, read; /* the times, in nanoseconds, at which the cancel callback was last called
                                     * and the clock was last read */
  uint64_t waits; /* number of times that the caller waited for other threads, at the end of an offer or of a
                   * run; a run with more indices than a share can hold counts several times */
  /* readings: number of calls between two readings of the clock; unread: number of calls until the next
   * reading */
  int readings, unread;
};

static inline void relax(void) {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

bool hl_pool_cancelled(hl_pool *pool) {
  if (atomic_load(&pool->cancelled)) return true;
  pool->asked = hl_clock_nanoseconds();
  if (!hl_cancelled(pool->context)) return false;
  atomic_store(&pool->cancelled, true);
  return true;
}

hl_status hl_pool_check(hl_pool *pool, const char *doing, hl_error *error) {
  return hl_pool_cancelled(pool) ? hl_fail(error, HL_ERROR_CANCELLED, "cancelled while %s", doing) : HL_OK;
}

/* Returns whether it is time to call the cancel callback. If calls of is_time_to_ask() follow each other
 * quickly, not every call reads the clock. */
static bool is_time_to_ask(hl_pool *pool) {
  if (pool->unread > 0) {
    pool->unread--;
    return false;
  }
  int64_t now = hl_clock_nanoseconds();
  bool quick = now - pool->read < NANOSECONDS_BETWEEN_READINGS;
  pool->read = now;
  pool->readings = quick ? (pool->readings < MOST_UNREAD ? 2 * pool->readings + 1 : MOST_UNREAD) : 0;
  pool->unread = pool->readings;
  return now - pool->asked >= NANOSECONDS_BETWEEN_QUESTIONS;
}

bool hl_pool_stops(hl_pool *pool, int worker) {
  bool cancelled = atomic_load_explicit(&pool->cancelled, memory_order_relaxed);
  if (cancelled || worker != 0 || !is_time_to_ask(pool)) return cancelled;
  return hl_pool_cancelled(pool);
}

void hl_pool_resume(hl_pool *pool) { atomic_store(&pool->cancelled, false); }

static uint64_t next_of(uint64_t range) { return range & INDEX_MASK; }
static uint64_t end_of(uint64_t range) { return range >> INDEX_BITS & INDEX_MASK; }
static uint64_t generation_of(uint64_t range) { return range >> (2 * INDEX_BITS); }

typedef struct claim {
  uint64_t generation, index;
} claim;

/* Claims the first or the last of the remaining indices of a share. */
static bool claim_of_share(share *share, bool first, claim *claimed) {
  uint64_t range = atomic_load(&share->range);
  while (next_of(range) < end_of(range)) {
    uint64_t left = first ? range + 1 : range - ONE_OF_END;
    if (!atomic_compare_exchange_weak(&share->range, &range, left)) continue;
    *claimed = (claim){generation_of(range), first ? next_of(range) : end_of(left)};
    return true;
  }
  return false;
}

static bool claim_index(const hl_pool *pool, share *shares, int number, claim *claimed) {
  for (int i = 0; i < pool->share_count; i++) {
    int whose = number + i < pool->share_count ? number + i : number + i - pool->share_count;
    if (claim_of_share(&shares[whose], (i == 0) == (whose % 2 == 0), claimed)) return true;
  }
  return false;
}

/* Claims and runs indices of the current job until all shares are empty. Since a job ends only when its
 * workers have reported their finished indices, all indices that a worker claims between two reports belong
 * to the same job. */
static void work(hl_pool *pool, int number) {
  claim claimed;
  while (claim_index(pool, pool->shares, number, &claimed)) {
    job *job = &pool->jobs[claimed.generation & 1];
    size_t done = 0;
    do {
      if (!hl_pool_stops(pool, number)) job->function(job->data, job->base + (size_t)claimed.index, number);
      done++;
    } while (claim_index(pool, pool->shares, number, &claimed));
    atomic_fetch_add(&job->done, done);
  }
}

static bool is_idle(hl_pool *pool, uint64_t generation) {
  return atomic_load(&pool->generation) == generation && !atomic_load(&pool->stop);
}

/* Claims and runs indices of the offer until a new job begins or the offer has no index left. */
static void work_on_offer(hl_pool *pool, int number, uint64_t generation) {
  job *job = &pool->offer.job;
  size_t done = 0;
  claim claimed;
  while (atomic_load(&pool->generation) == generation &&
         claim_index(pool, pool->offer.shares, number, &claimed)) {
    if (!hl_pool_stops(pool, number)) job->function(job->data, (size_t)claimed.index, number);
    done++;
  }
  if (done > 0) atomic_fetch_add(&job->done, done);
}

static void sleep_until_work(hl_pool *pool, uint64_t generation) {
  pthread_mutex_lock(&pool->mutex);
  atomic_fetch_add(&pool->sleepers, 1);
  while (is_idle(pool, generation)) pthread_cond_wait(&pool->wake, &pool->mutex);
  atomic_fetch_sub(&pool->sleepers, 1);
  pthread_mutex_unlock(&pool->mutex);
}

static void *worker_main(void *argument) {
  HL_DOOR;
  worker *self = argument;
  hl_pool *pool = self->pool;
  while (!atomic_load(&pool->stop)) {
    uint64_t generation = atomic_load(&pool->generation);
    work(pool, self->number);
    work_on_offer(pool, self->number, generation);
    int spin = 0;
    for (; spin < pool->spins && is_idle(pool, generation); spin++) relax();
    if (spin == pool->spins) sleep_until_work(pool, generation);
  }
  return NULL;
}

static void wake_sleepers(hl_pool *pool) {
  if (atomic_load(&pool->sleepers) == 0) return;
  pthread_mutex_lock(&pool->mutex);
  pthread_cond_broadcast(&pool->wake);
  pthread_mutex_unlock(&pool->mutex);
}

/* Waits until other threads have finished the indices that they claimed: first spins, then yields the
 * processor. */
static void wait_until_done(hl_pool *pool, const job *job, size_t count) {
  for (int spin = 0; atomic_load(&job->done) < count; spin++) {
    if (spin < pool->spins) relax();
    else sched_yield();
  }
}

/* Begins a job: divides its indices among the shares, and wakes the workers. The caller has set the job's
 * other members. */
static void begin_job(hl_pool *pool, job *job, share *shares, uint64_t generation, size_t count) {
  atomic_store(&job->done, 0);
  uint64_t threads = (uint64_t)pool->threads;
  for (uint64_t i = 0; i < threads; i++)
    atomic_store(&shares[i].range, generation << (2 * INDEX_BITS) | count * (i + 1) / threads << INDEX_BITS |
                                       count * i / threads);
  atomic_store(&pool->generation, generation);
  wake_sleepers(pool);
}

static void run_part(hl_pool *pool, size_t base, size_t count, void (*function)(void *, size_t, int),
                     void *data) {
  uint64_t generation = atomic_load(&pool->generation) + 1;
  job *job = &pool->jobs[generation & 1];
  job->function = function;
  job->data = data;
  job->base = base;
  begin_job(pool, job, pool->shares, generation, count);
  work(pool, 0);
  wait_until_done(pool, job, count);
  pool->waits++;
}

void hl_pool_run(hl_pool *pool, size_t count, void (*function)(void *, size_t, int), void *data) {
  pool->readings = pool->unread = 0; /* the clock is read again soon, because the time for an index of this
                                      * job is not known yet */
  if (pool->threads == 1 || count <= 1) {
    for (size_t index = 0; index < count && !hl_pool_stops(pool, 0); index++) function(data, index, 0);
    return;
  }
  for (size_t base = 0; base < count; base += INDEX_MASK)
    run_part(pool, base, count - base < INDEX_MASK ? count - base : INDEX_MASK, function, data);
}

void hl_pool_offer(hl_pool *pool, size_t count, void (*function)(void *, size_t, int), void *data) {
  if (pool->threads == 1 || count <= 1 || count > INDEX_MASK) {
    hl_pool_run(pool, count, function, data);
    return;
  }
  job *job = &pool->offer.job;
  job->function = function;
  job->data = data;
  pool->offer.count = count;
  /* The generation of an offer is 2 above the generation of the last job. The offer therefore has the parity
   * of the last job, whose shares are empty. */
  begin_job(pool, job, pool->offer.shares, atomic_load(&pool->generation) + 2, count);
}

void hl_pool_finish_offer(hl_pool *pool) {
  size_t count = pool->offer.count;
  if (count == 0) return;
  work_on_offer(pool, 0, atomic_load(&pool->generation));
  wait_until_done(pool, &pool->offer.job, count);
  pool->offer.count = 0;
  pool->waits++;
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
  size_t first = index * FLOATS_A_TASK,
         end = job->count - first < FLOATS_A_TASK ? job->count : first + FLOATS_A_TASK;
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

uint64_t hl_pool_waits(const hl_pool *pool) { return pool->waits; }

bool hl_pool_is_own(const hl_pool *pool) { return pool->process == getpid(); }

/* Starts the workers with all signals blocked: a new thread inherits the signal mask of the thread that
 * starts it. */
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
  int processors = hl_cpu_count();
  if (threads <= 0) threads = processors;
  if (threads > MAXIMUM_THREADS) threads = MAXIMUM_THREADS;
  hl_pool *made = hl_allocate_zeroed(context, 1, sizeof *made);
  worker *workers = hl_allocate_zeroed(context, (size_t)threads, sizeof *workers);
  share *shares = hl_allocate_zeroed(context, 2 * (size_t)threads, sizeof *shares);
  if (made == NULL || workers == NULL || shares == NULL) {
    hl_release(context, shares);
    hl_release(context, workers);
    hl_release(context, made);
    return hl_fail_memory(error, sizeof *made, "the thread pool");
  }
  made->context = context;
  made->threads = threads;
  made->spins = threads <= processors ? SPINS : 0;
  made->workers = workers;
  made->shares = shares;
  made->offer.shares = shares + threads;
  made->share_count = threads;
  pthread_mutex_init(&made->mutex, NULL);
  pthread_cond_init(&made->wake, NULL);
  made->process = getpid();
  start_workers(made);
  if (made->started < threads)
    hl_log(context, HL_LOG_WARNING, "the system starts only %d of %d threads: it will take longer",
           made->started, threads);
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
  hl_release(pool->context, pool->shares);
  hl_release(pool->context, pool->workers);
  hl_release(pool->context, pool);
}
