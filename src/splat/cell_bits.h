/* splat/cell_bits.h - a bit for each cell of a volume: whether what is reconstructed in it may show
 * something.
 *
 * Pixels of a sheet are points: a block of them shows nothing where none of its points lies in such a cell,
 * however much shows between them. That leaves out a quarter of the blocks that the boxes around them let
 * pass (relevant_lanes.h). In a cell, a cubic B-spline lies below the greatest of its Bezier points
 * (cell_bounds.h); other kernels get no bits. */
#ifndef HL_SPLAT_CELL_BITS_H
#define HL_SPLAT_CELL_BITS_H

#include "splat/classify.h"

enum {
  CELL_BIT_TAPS = HL_BRICK_CELLS + 3 /* voxels along an axis that a brick's cells depend on: 4b-2 .. 4b+4 */
};

/* Bit x + 4 y + 16 z: whether sign times the reconstruction may exceed a level, stored units, somewhere in
 * the brick's cell (x, y, z). */
typedef uint64_t brick_bits_function(const grid *grid, const int32_t brick[3], float sign, float level);

/* Whether a volume has bits: they are not to outgrow what they save. */
bool hl_cell_bits_wanted(const grid *grid, const kernel *kernel);
/* The bytes that they take at most. */
uint64_t hl_cell_bits_bytes(uint64_t bricks);

/* Finds them, once a transfer function: after the list of relevant bricks, before hl_cells_mark_near. */
void hl_cell_bits_find(grid *grid, const classifier *classifier, brick_bits_function *brick_bits,
                       hl_pool *pool);

#endif
