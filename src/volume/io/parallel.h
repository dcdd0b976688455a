/* volume/io/parallel.h - reads the parts of a volume (chunks, blocks) on all threads. */
#ifndef HL_VOLUME_PARALLEL_H
#define HL_VOLUME_PARALLEL_H

#include "core/pool.h"

/* Reads part `index`. Different parts must not write to the same voxels. worker: the thread's number, from 0
 * to the pool's number of threads - 1. */
typedef hl_status (*hl_part_reader)(void *data, size_t index, int worker, hl_error *error);

/* Calls read(data, index, worker) for each index in [0, count), and reports progress. If several parts fail,
 * the error of the lowest index is returned, independently of the number of threads. path: for error
 * lines. */
hl_status hl_parallel_read(hl_context *context, hl_pool *pool, const char *path, size_t count,
                           hl_part_reader read, void *data, hl_error *error);

#endif
