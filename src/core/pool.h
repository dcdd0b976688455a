/* core/pool.h - a team of threads with one verb: run a function for every index.
 *
 * The caller is worker 0 and works too. Indices are handed out one by one, so a function must not
 * depend on which worker gets which index; every output has one owner index.
 */
#ifndef HL_CORE_POOL_H
#define HL_CORE_POOL_H

#include "core/error.h"

typedef struct hl_pool hl_pool;

/* threads: at least 1, the caller included; 0: one per processor. */
hl_status hl_pool_create(hl_context *context, int threads, hl_pool **pool, hl_error *error);
void hl_pool_destroy(hl_pool *pool); /* null is allowed */
int hl_pool_threads(const hl_pool *pool);

/* Calls function(data, index, worker) for each index in [0, count), worker in [0, threads). Returns
 * when all are done. Not to be called from inside such a function. */
void hl_pool_run(hl_pool *pool, size_t count, void (*function)(void *data, size_t index, int worker), void *data);

#endif
