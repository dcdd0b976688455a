/* grid/bounds.h - finds the least and the greatest value that samples in each brick, and in each group of
 * 2x2x2 cells, can have. The bounds are found once for each volume.
 *
 * The bounds of a brick are the least and the greatest value of the voxels on which the brick's cells and the
 * cells around the brick depend. Cells are bounded more tightly: in a cell, a cubic B-spline lies between the
 * least and the greatest of its Bezier points. For the cell between the voxels b and c of four voxels a b c d
 * along an axis, the Bezier points are (a + 4 b + c) / 6, (2 b + c) / 3, (b + 2 c) / 3 and (b + 4 c + d) / 6.
 * All weights are non-negative, so bounds found along one axis can serve as input along the next axis. In
 * noise around a threshold, Bezier points may leave half as many visible cells as the least and the greatest
 * voxel do. For other kernels, cells are bounded by the least and the greatest voxel. */
#ifndef HL_GRID_BOUNDS_H
#define HL_GRID_BOUNDS_H

#include "core/memory.h"
#include "grid/grid.h"

/* ---- bricks ---- */

/* Lays out the grid's arrays brick_bounds, `relevant` and relevant_list. The grid's storage and brick_count
 * must be set. */
void hl_bricks_lay_out(grid *grid, hl_layout *layout);
/* Fills the grid's brick_bounds, and clears `relevant`. */
hl_status hl_bricks_bound(hl_context *context, hl_pool *pool, const grid_functions *functions, grid *grid,
                          hl_error *error);
/* Calls a function for layers of bricks. If several ranks hold the voxels, each rank makes the calls for its
 * part of the layers, and then receives the results that the other ranks have stored. function: as for
 * hl_pool_run(); its index is the number of a layer less *first. first: belongs to `data`; receives the first
 * layer of this rank's part. stored: [layers][layer_bytes], which the calls fill. */
void hl_bricks_run(hl_pool *pool, const grid *grid, void (*function)(void *data, size_t index, int worker),
                   void *data, size_t *first, void *stored, size_t layer_bytes);
/* The least and greatest stored value of a brick. */
void hl_bounds_of_brick(const grid *grid, size_t brick, float bounds[2]);

/* ---- cells ---- */

/* Lays out the grid's look-ups and the array cell_bounds, and sets the counts of the look-ups. The grid's
 * dimension and brick_count must be set. If 32 bits cannot number the cells, nothing is laid out. */
void hl_cells_lay_out(grid *grid, hl_layout *layout);
/* Fills the grid's array cell_bounds, whose elements must be null: each layer is allocated when packing has
 * found the layer's size. smooth: whether the kernel is the B-spline. */
hl_status hl_cells_bound(hl_context *context, hl_pool *pool, const grid_functions *functions, bool smooth,
                         const hl_volume *volume, grid *grid, hl_error *error);
void hl_cell_bounds_release(hl_context *context, grid *grid);

/* Counts the memory that hl_bricks_bound() and then hl_cells_bound() take, for a grid that is laid out. The
 * count holds the packed layers at their greatest size, and the scratch memory of each function, which is
 * released at the function's end. */
void hl_bounds_count(const grid *grid, int threads, hl_layout *layout);

/* Finds the bounds of the group of 2x2x2 cells with the coordinates `cell`, in stored units. The function is
 * slow, because it walks through the packed bounds of a layer. */
void hl_cell_bounds_at(const grid *grid, const int32_t cell[3], float *low, float *high);

/* The form of the packed bounds of a layer of bricks. The packed bounds begin with a bit for each brick; each
 * row of bricks starts a new byte. The bit is 1 if the brick is even, which means that all eight groups of
 * 2x2x2 cells in the brick have the same bounds. The bricks' bounds follow, brick after brick: two bounds
 * (lower, upper) for an even brick, else eight lower and eight upper bounds. The bounds of group (i, j, k)
 * have the number i + 2 j + 4 k. Groups beyond the grid have the bounds of their neighbours. */
enum { BRICK_CELLS = 8, EVEN_BYTES = 2, UNEVEN_BYTES = 2 * BRICK_CELLS };

static inline size_t hl_even_row_bytes(const grid *grid) { return ((size_t)grid->brick_count[0] + 7) / 8; }
static inline bool hl_brick_is_even(const unsigned char *even_row, int32_t brick_x) {
  return even_row[brick_x / 8] >> (brick_x % 8) & 1;
}

#endif
