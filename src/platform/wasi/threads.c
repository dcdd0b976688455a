/* platform/wasi/threads.c - implements POSIX threads by WebAssembly's atomic waits, because the C library's
 * functions neither start threads nor wait for them.
 *
 * Mutexes follow Drepper's second mutex ("Futexes are tricky", 2011): the value 0 means open, 1 means held,
 * and 2 means held while another thread waits. A condition variable is a count of its signals: a thread that
 * waits for the condition reads the count before it opens the mutex, and sleeps until the count has
 * changed. */
#include "platform/wasi/threads.h"

#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stddef.h>

#include "platform/processors.h"

enum { MISSING, FREE, TAKEN, CALLED, RETURNED }; /* states of a helper */

typedef struct helper {
  atomic_int state;
  void *(*function)(void *);
  void *argument;
} helper;

static helper helpers[MOST_HELPERS];
static atomic_int allowed = 1;

/* Sleeps as long as *number equals `expected`. The numbers have 32 bits, because WebAssembly's instruction
 * for waiting requires 32 bits. */
static void wait_while(atomic_int *number, int expected) {
  __builtin_wasm_memory_atomic_wait32((int *)number, expected, -1);
}

static void wake(atomic_int *number, unsigned count) {
  __builtin_wasm_memory_atomic_notify((int *)number, count);
}

/* ---- helpers ---- */

void hl_helpers_allow(int threads) { atomic_store(&allowed, threads); }

int hl_helpers_free(void) {
  int count = 0;
  for (int i = 0; i < MOST_HELPERS; i++) count += atomic_load(&helpers[i].state) == FREE;
  return count;
}

int hl_cpu_count(void) {
  int most = atomic_load(&allowed), count = 1 + hl_helpers_free();
  return count < most ? count : most;
}

bool hl_helper_arrive(int number) {
  if (number < 0 || number >= MOST_HELPERS) return false;
  atomic_store(&helpers[number].state, FREE);
  return true;
}

static void set_state(helper *one, int state) {
  atomic_store(&one->state, state);
  wake(&one->state, (unsigned)-1);
}

void hl_helper_serve(int number) {
  helper *self = &helpers[number];
  for (;;) {
    int state = atomic_load(&self->state);
    if (state != CALLED) {
      wait_while(&self->state, state);
      continue;
    }
    self->function(self->argument);
    set_state(self, RETURNED);
  }
}

/* ---- threads ---- */

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*function)(void *),
                   void *argument) {
  (void)attributes;
  for (int i = 0; i < MOST_HELPERS; i++) {
    int expected = FREE;
    if (!atomic_compare_exchange_strong(&helpers[i].state, &expected, TAKEN)) continue;
    helpers[i].function = function;
    helpers[i].argument = argument;
    set_state(&helpers[i], CALLED);
    *thread = (pthread_t)&helpers[i];
    return 0;
  }
  return EAGAIN;
}

int pthread_join(pthread_t thread, void **result) {
  helper *one = (helper *)thread;
  for (int state; (state = atomic_load(&one->state)) != RETURNED;) wait_while(&one->state, state);
  if (result != NULL) *result = NULL; /* the result is not stored, because no caller uses it */
  set_state(one, FREE);
  return 0;
}

/* ---- mutexes and conditions ---- */

static void lock(atomic_int *number) {
  int found = 0;
  if (atomic_compare_exchange_strong(number, &found, 1)) return;
  if (found != 2) found = atomic_exchange(number, 2);
  while (found != 0) {
    wait_while(number, 2);
    found = atomic_exchange(number, 2);
  }
}

static void unlock(atomic_int *number) {
  if (atomic_exchange(number, 0) == 2) wake(number, 1);
}

static atomic_int *number_of(void *object) { return object; }

int pthread_mutex_init(pthread_mutex_t *mutex, const pthread_mutexattr_t *attributes) {
  (void)attributes;
  atomic_store(number_of(mutex), 0);
  return 0;
}

int pthread_mutex_destroy(pthread_mutex_t *mutex) {
  (void)mutex;
  return 0;
}

int pthread_mutex_lock(pthread_mutex_t *mutex) {
  lock(number_of(mutex));
  return 0;
}

int pthread_mutex_unlock(pthread_mutex_t *mutex) {
  unlock(number_of(mutex));
  return 0;
}

int pthread_cond_init(pthread_cond_t *condition, const pthread_condattr_t *attributes) {
  (void)attributes;
  atomic_store(number_of(condition), 0);
  return 0;
}

int pthread_cond_destroy(pthread_cond_t *condition) {
  (void)condition;
  return 0;
}

int pthread_cond_wait(pthread_cond_t *condition, pthread_mutex_t *mutex) {
  int before = atomic_load(number_of(condition));
  pthread_mutex_unlock(mutex);
  wait_while(number_of(condition), before);
  pthread_mutex_lock(mutex);
  return 0;
}

int pthread_cond_broadcast(pthread_cond_t *condition) {
  atomic_fetch_add(number_of(condition), 1);
  wake(number_of(condition), (unsigned)-1);
  return 0;
}

int pthread_cond_signal(pthread_cond_t *condition) { return pthread_cond_broadcast(condition); }
