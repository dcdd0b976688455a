/* grid/relevant.h - which bricks and cells a transfer function shows something of, found once a transfer
 * function.
 *
 * A voxel can be dropped only if every point that it contributes to is transparent, whatever else contributes
 * there. By the convex hull of non-negative kernels, a point's density lies between the least and the
 * greatest of its 64 voxels; a sum over some of them lies between those and empty. So a brick is relevant if
 * anything between its bounds, stretched to empty, is visible (derived). The bounds take in one more cell on
 * each side: slabs across the brick's faces read those neighbours. */
#ifndef HL_GRID_RELEVANT_H
#define HL_GRID_RELEVANT_H

#include "grid/classifier.h"

/* Finds which bricks are relevant, the look-ups of visible cells, and the cells' bits. */
void hl_grid_mark_relevant(grid *grid, const grid_functions *functions, const classifier *classifier,
                           hl_pool *pool);

/* Index space: the box of the points in a brick's cells, `margin` voxels larger at the grid's borders. */
void hl_brick_bounds(const grid *grid, const int32_t b[3], double margin, double centre[3], double half[3]);
/* The box around all relevant bricks; false if there is none. */
bool hl_relevant_bounds(const grid *grid, double margin, double low[3], double high[3]);

/* Pixels of a sheet are points: a block of pixels shows nothing where no pixel lies in a cell that may show
 * something, however much there is between the pixels. A bit for each cell leaves out a quarter of the blocks
 * that the boxes around them let pass (fill/relevant_blocks_lanes.h). In a cell, a cubic B-spline lies below
 * the greatest of its Bezier points (bounds.h); grids for other kernels get no bits. */
enum {
  CELL_BIT_TAPS = HL_BRICK_CELLS + 3 /* voxels along an axis that a brick's cells depend on: 4b-2 .. 4b+4 */
};

/* The bytes of so many bricks' bits: none for large volumes, which go without. */
uint64_t hl_cell_bits_bytes(uint64_t bricks);

#endif
