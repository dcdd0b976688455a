/* grid/relevant.h - finds the bricks and cells in which the transfer function shows something. The bricks and
 * cells are found once for each transfer function.
 *
 * A voxel can be left out only if every point to which it contributes is transparent, whichever other voxels
 * are left out. Kernels are not negative, and their weights add up to 1. So a point's density lies between
 * the least and the greatest of the 64 voxels around the point. If some of the 64 voxels are left out, the
 * density lies in this range widened to include the empty value. Derived: a brick is relevant if any value is
 * visible in the range of the brick's bounds, widened to include the empty value. The bounds include one more
 * cell on each side of the brick, because slabs across the brick's faces read these neighbours. */
#ifndef HL_GRID_RELEVANT_H
#define HL_GRID_RELEVANT_H

#include "core/memory.h"
#include "grid/classifier.h"

/* Finds, for a grid and a transfer function, which bricks are relevant, the look-ups of visible cells, and
 * the bits of cells. */
void hl_grid_mark_relevant(grid *grid, const grid_functions *functions, const classifier *classifier,
                           hl_pool *pool);

/* Finds the box, in index space, of the points in a brick's cells. At the grid's borders the box is larger by
 * `margin` voxels. */
void hl_brick_bounds(const grid *grid, const int32_t b[3], double margin, double centre[3], double half[3]);
/* Finds the box around all relevant bricks. Returns false if no brick is relevant. */
bool hl_relevant_bounds(const grid *grid, double margin, double low[3], double high[3]);

/* Finds the box around the content: relevant bricks, and bricks that only a mask hides. The grid must have at
 * least one such brick. */
void hl_content_bounds(const grid *grid, double margin, double low[3], double high[3]);

/* The place, in voxels, to which faces that cut nothing visible are moved: far outside of the grid. */
#define FACE_FAR_OUT 1e9f

/* Opens the faces of a grid that touch another grid's box. Matter goes on beyond these faces, so they are
 * moved far outside, where they cut nothing. Most often the two grids are parts of one volume. */
void hl_open_faces(grid *grid, const struct grid *other);

/* Functions for the bits of cells. A pixel samples a sheet at one point. So a block of pixels is empty if no
 * pixel's point lies in a cell that may show something; cells between the points do not matter. With a bit
 * for each cell, a quarter of the blocks that pass the test by boxes (fill/relevant_blocks_lanes.h) turn out
 * to be empty. In a cell, a cubic B-spline lies below the greatest of its Bezier points (bounds.h); grids for
 * other kernels get no bits. */
enum {
  CELL_BIT_TAPS = HL_BRICK_CELLS + 3 /* voxels along an axis on which a brick's cells depend: 4b-2 .. 4b+4 */
};

/* Lays out the grid's array cell_bits. Large volumes get no such array. Whether the voxels lie in memory or
 * in pages makes no difference: the light of a sky depends on the bits (field/opacity_lanes.h). */
void hl_cell_bits_lay_out(grid *grid, hl_layout *layout);

#endif
