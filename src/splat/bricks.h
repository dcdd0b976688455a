/* splat/bricks.h - making a grid from a volume: bounds of every brick, and which bricks matter. */
#ifndef HL_SPLAT_BRICKS_H
#define HL_SPLAT_BRICKS_H

#include "splat/cell_bits.h"
#include "splat/cell_bounds.h"
#include "splat/columns.h"

/* Rows of stored values reduced to their elementwise bounds; count values. One per storage type, chosen
 * per instruction set (see simd/hot.h). rows: row_count pointers. */
typedef void bound_rows_function(const void *const *rows, int row_count, size_t count, float *least,
                                 float *greatest);

typedef struct grid_functions {
  bound_rows_function *rows[3]; /* by hl_storage */
  bound_along_function *along;
  bound_across_function *across;
  brick_bits_function *brick_bits;
  column_slice_function *column_slice; /* null where no function reads columns */
} grid_functions;

/* volume: kept alive by the caller. kernel: cells are bounded for it. to_frame: index space to frame space.
 * empty: data value. */
hl_status hl_grid_create(hl_context *context, hl_pool *pool, const grid_functions *functions,
                         const kernel *kernel, const hl_scene_volume *volume, affine3 index_to_frame,
                         double empty, grid *grid, hl_error *error);
/* The bytes that it takes. */
uint64_t hl_grid_bytes(const hl_volume *volume, const grid_functions *functions, int threads);
void hl_grid_release(hl_context *context, grid *grid);

/* Marks the bricks that the transfer function can show, and counts their voxels. */
void hl_grid_mark_relevant(grid *grid, const grid_functions *functions, const classifier *classifier,
                           hl_pool *pool);

#endif
