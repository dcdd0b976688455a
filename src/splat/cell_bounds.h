/* splat/cell_bounds.h - what the reconstruction can reach in every 2x2x2 cells of a volume, tightly.
 *
 * Between four neighbouring voxels a cubic B-spline lies within its Bezier points: along an axis, from voxels a b c d,
 * (a + 4 b + c) / 6, (2 b + c) / 3, (b + 2 c) / 3 and (b + 4 c + d) / 6. All are means with weights that are not
 * negative, so bounds along one axis may be bounded along the next. Noise around a threshold then marks
 * half as many cells as the voxels' own extremes would, which bound the other kernels. */
#ifndef HL_SPLAT_CELL_BOUNDS_H
#define HL_SPLAT_CELL_BOUNDS_H

#include "splat/classify.h"

enum { CELL_TAPS = 5 /* voxels along an axis that two cells depend on */ };

/* Bounds of pairs of cells along x: pair f depends on voxels 2f-2 .. 2f+2, held at the ends. row: count stored values.
 * padded: scratch, count + 6 floats. low, high: count / 2 + 1. smooth: the kernel is the B-spline. */
typedef void bound_along_function(hl_storage storage, const void *row, int32_t count, bool smooth, float *padded,
                                  float *low, float *high);
/* The same across rows of bounds, elementwise. */
typedef void bound_across_function(const float *const low_rows[CELL_TAPS], const float *const high_rows[CELL_TAPS],
                                   size_t count, bool smooth, float *low, float *high);

/* Fills the grid's cell_low and cell_high. */
hl_status hl_cell_bounds_build(hl_context *context, hl_pool *pool, bound_along_function *along,
                               bound_across_function *across, bool smooth, grid *grid, hl_error *error);

/* The bytes that it takes for such a grid, its scratch included. */
uint64_t hl_cell_bounds_bytes(const size_t dimension[3], int threads);

/* Fills visible and near from the bounds, the transfer function and the relevant bricks. */
void hl_cells_mark_near(grid *grid, const classifier *classifier, hl_pool *pool);

#endif
