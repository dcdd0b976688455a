/* core/pool.h - a team of threads with one verb: run a function for every index.
 *
 * The caller is worker 0 and works too. Indices are handed out one by one, so a function must not
 * depend on which worker gets which index; every output has one owner index.
 *
 * Between indices the caller asks the context's cancel callback, every few milliseconds at most. Once it says
 * stop, indices not yet begun are skipped, in this run and in all later runs. The results are then
 * incomplete: call hl_pool_cancelled before using them.
 */
#ifndef HL_CORE_POOL_H
#define HL_CORE_POOL_H

#include <stdbool.h>

#include "core/error.h"

typedef struct hl_pool hl_pool;

/* threads: at least 1, the caller included; 0: one per processor. Where the system starts fewer, the team is
 * smaller, and a warning says so. The threads take no signals: those go to the program's own. */
hl_status hl_pool_create(hl_context *context, int threads, hl_pool **pool, hl_error *error);
void hl_pool_destroy(hl_pool *pool); /* null is allowed */

/* False in a child process made by fork(): threads stay with the parent. All that can be done there with the
 * pool is to destroy it. */
bool hl_pool_is_own(const hl_pool *pool);
int hl_pool_threads(const hl_pool *pool);

/* Calls function(data, index, worker) for each index in [0, count), worker in [0, threads). Returns
 * when all are done. Not to be called from inside such a function. */
void hl_pool_run(hl_pool *pool, size_t count, void (*function)(void *data, size_t index, int worker),
                 void *data);

/* Sets floats[0 .. count) to value, on all threads. */
void hl_pool_fill(hl_pool *pool, float *floats, size_t count, float value);
/* Sets all bytes to value, or to zero, on all threads. */
void hl_pool_set(hl_pool *pool, void *memory, size_t bytes, int value);
void hl_pool_clear(hl_pool *pool, void *memory, size_t bytes);

/* Whether to stop: asks anew, from the calling thread between runs. */
bool hl_pool_cancelled(hl_pool *pool);

/* The same from within a function whose single index takes long: cheap, and only worker 0 asks anew. */
bool hl_pool_stops(hl_pool *pool, int worker);

/* A pool that was stopped works again. */
void hl_pool_resume(hl_pool *pool);

#endif
