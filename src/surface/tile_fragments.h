/* surface/tile_fragments.h - rasterises the triangles and spheres of a tile into fragments.
 *
 * In: primitives sorted by tiles (primitive_bins.h), and where the view sees their corners (seen.h). Out: the
 * tile's fragments in a thread's blocks, which fragments.c keeps. */
#ifndef HL_SURFACE_TILE_FRAGMENTS_H
#define HL_SURFACE_TILE_FRAGMENTS_H

#include "surface/fragment_work.h"

void hl_fragment_blocks_release(hl_context *context, fragment_block *latest);

/* Sets the members of the work that depend only on the view: `small` and `near`. */
void hl_fragment_work_begin(fragment_work *work);

/* Allocates the arrays of a worker that do not grow. Returns false if there is no memory. */
bool hl_fragment_worker_begin(hl_context *context, fragment_worker *worker, int sheets);
/* Releases all memory of a worker except the blocks that hold the finished tiles' fragments. */
void hl_fragment_worker_end(hl_context *context, fragment_worker *worker);

/* Makes one tile's fragments. It is a task of the pool. data: fragment_work. */
void hl_make_tile_fragments(void *data, size_t tile, int worker_index);

#endif
