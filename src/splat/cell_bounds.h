/* splat/cell_bounds.h - what the reconstruction can reach in every 2x2x2 cells of a volume, tightly.
 *
 * Between four neighbouring voxels a cubic B-spline lies within its Bezier points: along an axis, from voxels
 * a b c d, (a + 4 b + c) / 6, (2 b + c) / 3, (b + 2 c) / 3 and (b + 4 c + d) / 6. All are means with weights
 * that are not negative, so bounds along one axis may be bounded along the next. Noise around a threshold
 * then marks half as many cells as the voxels' own extremes would, which bound the other kernels. */
#ifndef HL_SPLAT_CELL_BOUNDS_H
#define HL_SPLAT_CELL_BOUNDS_H

#include "splat/classify.h"

enum { CELL_TAPS = 5 /* voxels along an axis that two cells depend on */ };

/* Bounds of pairs of cells along x: pair f depends on voxels 2f-2 .. 2f+2, held at the ends. row: count
 * stored values. padded: scratch, count + 6 floats. low, high: count / 2 + 1. smooth: the kernel is the
 * B-spline. */
typedef void bound_along_function(hl_storage storage, const void *row, int32_t count, bool smooth,
                                  float *padded, float *low, float *high);
/* The same across rows of bounds, elementwise. */
typedef void bound_across_function(const float *const low_rows[CELL_TAPS],
                                   const float *const high_rows[CELL_TAPS], size_t count, bool smooth,
                                   float *low, float *high);

/* Fills the grid's cell_bounds, and makes room for its levels. */
hl_status hl_cell_bounds_build(hl_context *context, hl_pool *pool, bound_along_function *along,
                               bound_across_function *across, bool smooth, grid *grid, hl_error *error);
void hl_cell_bounds_release(hl_context *context, grid *grid);

/* The bytes that it takes for such a grid at most, its scratch included. */
uint64_t hl_cell_bounds_bytes(const size_t dimension[3], int threads);

/* The bounds of 2x2x2 cells, [count z][y][x]: walks through a layer. */
void hl_cell_bounds_at(const grid *grid, const int32_t cell[3], float *low, float *high);

/* ---- cell_marks.c ---- */

/* Writes 1 into the levels' near where the transfer function and the relevant bricks let something be seen,
 * else 0. */
void hl_cells_mark_visible(grid *grid, const classifier *classifier, hl_pool *pool);
/* Makes of that what near is to be. */
void hl_cells_mark_near(grid *grid, hl_pool *pool);

/* Whether a brick has a cell that shows something: between the two. */
static inline bool hl_brick_is_visible(const grid *grid, size_t brick) {
  return grid->level[1].near == NULL || grid->level[1].near[brick];
}

/* The least and greatest stored value of a brick (bricks.c). */
void hl_bounds_of_brick(const grid *grid, size_t brick, float bounds[2]);

/* Bounds of the cells of a layer of bricks as they are packed: first a bit for each brick, rows in whole
 * bytes, 1 where all eight of its cells have the same bounds; then, brick after brick, those (lower, upper),
 * or eight lower and eight upper ones, cell i + 2 j + 4 k at place (i, j, k). Cells beyond the grid are as
 * their neighbours. */
enum { BRICK_CELLS = 8, EVEN_BYTES = 2, UNEVEN_BYTES = 2 * BRICK_CELLS };

static inline size_t hl_even_row_bytes(const grid *grid) { return ((size_t)grid->brick_count[0] + 7) / 8; }
static inline bool hl_brick_is_even(const unsigned char *even_row, int32_t brick_x) {
  return even_row[brick_x / 8] >> (brick_x % 8) & 1;
}

#endif
