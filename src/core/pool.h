/* core/pool.h - runs a team of threads, which runs a function for every index.
 *
 * The caller takes part in the work as worker 0. Any worker may get any index, so the results of the function
 * that a pool runs must not depend on the worker, and the calls for two indices must not write to the same
 * output.
 *
 * Between two indices the caller polls the context's cancel callback, at most once every few milliseconds. If
 * the cancel callback asks to stop, the pool skips all indices that have not begun, in this run and in all
 * later runs. The results of a cancelled run are incomplete: callers check hl_pool_cancelled() before they
 * use results. */
#ifndef HL_CORE_POOL_H
#define HL_CORE_POOL_H

#include <stdbool.h>

#include "core/error.h"

typedef struct hl_pool hl_pool;

/* Makes a pool, which is a team of threads. threads: the number of threads, including the caller; 0 stands
 * for one thread for each processor. If the system refuses to start some of the threads, the team is smaller
 * and a warning says so. The threads block all signals, so that signals reach the program's own threads. */
hl_status hl_pool_create(hl_context *context, int threads, hl_pool **pool, hl_error *error);
void hl_pool_destroy(hl_pool *pool); /* `pool` may be null */

/* Returns whether the pool belongs to this process. In a child process made by fork() the result is false:
 * the child process has no threads of the pool, and can only destroy the pool. */
bool hl_pool_is_own(const hl_pool *pool);
int hl_pool_threads(const hl_pool *pool);
/* The number of times that the caller has waited for other threads since the pool was made. The caller waits
 * at the end of each run with several threads, and at the end of each offer. */
uint64_t hl_pool_waits(const hl_pool *pool);

/* Calls function(data, index, worker) for each index in [0, count), worker in [0, threads). Returns when all
 * calls are done. The function that a pool runs must not call hl_pool_run() itself. */
void hl_pool_run(hl_pool *pool, size_t count, void (*function)(void *data, size_t index, int worker),
                 void *data);

/* Offers the calls that hl_pool_run() would make, and returns at once. A pool of one thread makes all calls
 * itself before it returns. During later runs, threads without work make the offered calls.
 * hl_pool_finish_offer() makes the remaining calls, and waits until other threads have finished their offered
 * calls. Before hl_pool_finish_offer() has returned, the memory that the calls read must not be written, and
 * nothing else may be offered. */
void hl_pool_offer(hl_pool *pool, size_t count, void (*function)(void *data, size_t index, int worker),
                   void *data);
/* waits for the offered calls; returns at once if nothing is offered */
void hl_pool_finish_offer(hl_pool *pool);

/* Sets the floats from index 0 to count - 1 to a value, on all threads. */
void hl_pool_fill(hl_pool *pool, float *floats, size_t count, float value);
/* Sets all bytes of a block of memory to a value, or to zero, on all threads. */
void hl_pool_set(hl_pool *pool, void *memory, size_t bytes, int value);
void hl_pool_clear(hl_pool *pool, void *memory, size_t bytes);

/* Returns whether work must stop. The function polls the cancel callback. Only the calling thread may call
 * the function, between runs. */
bool hl_pool_cancelled(hl_pool *pool);

/* Returns HL_ERROR_CANCELLED, with the line "cancelled while DOING", if hl_pool_cancelled() is true; else
 * HL_OK. */
hl_status hl_pool_check(hl_pool *pool, const char *doing, hl_error *error);

/* Returns whether work must stop. Functions that work long on a single index call hl_pool_stops() repeatedly.
 * A call takes little time, because only worker 0 polls the cancel callback. */
bool hl_pool_stops(hl_pool *pool, int worker);

/* Clears the pool's stop state, so that the pool runs indices again. */
void hl_pool_resume(hl_pool *pool);

#endif
