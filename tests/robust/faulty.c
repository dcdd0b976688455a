/* tests/robust/faulty.c - see faulty.h. */
#include "faulty.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/pool.h"

/* New memory is filled with this byte. Code that reads it as an index reads far beyond every array. */
enum { UNWRITTEN = 0x76 };

/* The linker calls these functions in place of the pool's. The renderer asks whether to stop every few
 * milliseconds, which is seldom in a frame of a few pixels. So these functions ask before each run of the
 * pool and in the middle of it, when a part of the results is written and a part is not. */
typedef void pool_function(void *data, size_t index, int worker);

void __wrap_hl_pool_run(hl_pool *pool, size_t count, pool_function *function, void *data);
void __real_hl_pool_run(hl_pool *pool, size_t count, pool_function *function, void *data);
void __wrap_hl_pool_offer(hl_pool *pool, size_t count, pool_function *function, void *data);
void __real_hl_pool_offer(hl_pool *pool, size_t count, pool_function *function, void *data);
void __wrap_hl_pool_fill(hl_pool *pool, float *floats, size_t count, float value);
void __real_hl_pool_fill(hl_pool *pool, float *floats, size_t count, float value);
void __wrap_hl_pool_set(hl_pool *pool, void *memory, size_t bytes, int value);
void __real_hl_pool_set(hl_pool *pool, void *memory, size_t bytes, int value);
void __wrap_hl_pool_clear(hl_pool *pool, void *memory, size_t bytes);
void __real_hl_pool_clear(hl_pool *pool, void *memory, size_t bytes);

typedef struct asking_run {
  hl_pool *pool;
  pool_function *function;
  void *data;
  size_t middle; /* the caller of the run asks before this index */
  bool asked;
} asking_run;

static void run_index(void *data, size_t index, int worker) {
  asking_run *run = data;
  if (worker == 0 && index >= run->middle && !run->asked) {
    run->asked = true;
    if (hl_pool_cancelled(run->pool)) return;
  }
  run->function(run->data, index, worker);
}

void __wrap_hl_pool_run(hl_pool *pool, size_t count, pool_function *function, void *data) {
  asking_run run = {pool, function, data, (count + 1) / 2, false};
  hl_pool_cancelled(pool);
  __real_hl_pool_run(pool, count, run_index, &run);
}

void __wrap_hl_pool_offer(hl_pool *pool, size_t count, pool_function *function, void *data) {
  hl_pool_cancelled(pool);
  __real_hl_pool_offer(pool, count, function, data);
}

void __wrap_hl_pool_fill(hl_pool *pool, float *floats, size_t count, float value) {
  hl_pool_cancelled(pool);
  __real_hl_pool_fill(pool, floats, count, value);
}

void __wrap_hl_pool_set(hl_pool *pool, void *memory, size_t bytes, int value) {
  hl_pool_cancelled(pool);
  __real_hl_pool_set(pool, memory, bytes, value);
}

void __wrap_hl_pool_clear(hl_pool *pool, void *memory, size_t bytes) {
  hl_pool_cancelled(pool);
  __real_hl_pool_clear(pool, memory, bytes);
}

static bool strikes(faulty *f, atomic_long *left, bool for_good) {
  long before = atomic_load(left);
  if (before < 0) return false;
  before = atomic_fetch_sub(left, 1);
  if (before > 0) return false;
  if (for_good) atomic_store(left, 0);
  if (before == 0 || for_good) atomic_store(&f->struck, true);
  return before == 0 || for_good;
}

static void *allocate(void *user_data, size_t size, size_t alignment) {
  faulty *f = user_data;
  if (strikes(f, &f->allocations_left, atomic_load(&f->for_good))) return NULL;
  const size_t bytes = (size + alignment - 1) / alignment * alignment;
  void *memory = aligned_alloc(alignment, bytes);
  if (memory != NULL && atomic_load(&f->fills)) memset(memory, UNWRITTEN, bytes);
  return memory;
}

static void release(void *user_data, void *memory) {
  (void)user_data;
  free(memory);
}

static int cancelled(void *user_data) {
  faulty *f = user_data;
  return strikes(f, &f->questions_left, false);
}

static faulty *at_work; /* null: the system's allocator does not fail */
static atomic_bool system_struck;

bool faulty_system_at_work(void) { return at_work != NULL; }

bool faulty_system_strikes(void) {
  faulty *f = at_work;
  if (f == NULL || !strikes(f, &f->allocations_left, atomic_load(&f->for_good))) return false;
  atomic_store(&system_struck, true);
  return true;
}

void faulty_open(faulty *f) {
  *f = (faulty){.context = NULL};
  atomic_store(&f->allocations_left, -1);
  atomic_store(&f->questions_left, -1);
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.user_data = f;
  options.allocate = allocate;
  options.release = release;
  options.cancelled = cancelled;
  assert_int_equal(hl_context_create(&options, &f->context, NULL), HL_OK);
}

void faulty_close(faulty *f) {
  assert_int_equal(hl_context_memory_held(f->context), 0);
  hl_context_destroy(f->context);
}

static void disarm(faulty *f) {
  atomic_store(&f->allocations_left, -1);
  atomic_store(&f->questions_left, -1);
  atomic_store(&f->for_good, false);
}

/* Runs the work with a fault ahead. Returns false if the work came to its end before the fault. */
static bool run(faulty *f, faulty_work *work, faulty_work *after, void *data, hl_status expected,
                bool may_recover) {
  hl_error error = {0};
  uint64_t held = hl_context_memory_held(f->context);
  atomic_store(&f->struck, false);
  atomic_store(&system_struck, false);
  at_work = f;
  hl_status status = work(f, data, &error);
  at_work = NULL;
  disarm(f);
  if (!atomic_load(&f->struck)) {
    if (status != HL_OK) print_error("%s\n", error.message);
    assert_int_equal(status, HL_OK);
    return false;
  }
  if (atomic_load(&system_struck)) expected = status;
  if ((may_recover || atomic_load(&system_struck)) && status == HL_OK) {
    if (after == NULL) assert_true(hl_context_memory_held(f->context) == held);
    return true;
  }
  if (status != expected) print_error("%d: %s\n", (int)status, error.message);
  assert_int_equal(status, expected);
  assert_int_equal(error.code, expected);
  assert_true(error.message[0] != 0 && strchr(error.message, '\n') == NULL);
  if (expected == HL_ERROR_MEMORY) assert_non_null(strstr(error.message, "memory"));
  if (after != NULL) assert_int_equal(after(f, data, &error), HL_OK);
  else assert_true(hl_context_memory_held(f->context) == held);
  return true;
}

/* The first EACH allocations fail one by one, and then every STEPth, since later ones come from loops over
 * things of the same kind. A sanitizer makes the work fifteen times slower. It looks for other faults in the
 * same code, for which fewer failures are enough. */
/* the way in which clang tells that there is a sanitizer */
#if defined(__has_feature) && !defined(__SANITIZE_ADDRESS__)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
enum { EACH = 24, STEP = 31 };
#else
enum { EACH = 150, STEP = 7 };
#endif

long faulty_fail_each(faulty *f, faulty_work *work, faulty_work *after, void *data) {
  for (long n = 0;; n += n < EACH ? 1 : STEP)
    for (int for_good = 0; for_good < 2; for_good++) {
      atomic_store(&f->for_good, for_good != 0);
      atomic_store(&f->allocations_left, n);
      bool recovers = for_good ? f->may_do_without : f->may_recover;
      if (!run(f, work, after, data, HL_ERROR_MEMORY, recovers)) return n;
    }
}

long faulty_stop_each(faulty *f, faulty_work *work, faulty_work *after, void *data) {
  long n = 0;
  atomic_store(&f->fills, true);
  for (bool stopped = true; stopped; n += n < EACH ? 1 : STEP) {
    atomic_store(&f->questions_left, n);
    stopped = run(f, work, after, data, HL_ERROR_CANCELLED, false);
  }
  atomic_store(&f->fills, false);
  return n;
}
