/* fill/gather_lanes.h - gathering: sums, for each pixel's density, the 4x4x4 voxels around the pixel's point,
 * weighted by the kernel.
 *
 * Four u8 voxels along x are loaded as one word of 32 bits. Voxels are added in a fixed order: in pairs along
 * x, then along y, then along z. */
#ifndef HL_FILL_GATHER_LANES_H
#define HL_FILL_GATHER_LANES_H

#include "fill/block_lanes.h"
#include "fill/row_lanes.h"
#include "fill/windows_lanes.h"
#include "simd/gathers.h"

/* The addresses of the 64 taps (the voxels around a point) of every lane. All taps lie in the grid. */
typedef struct tap_window {
  const unsigned char *voxels;
  lanes_offsets offsets; /* for each lane, the number of bytes from `voxels` to the lane's tap (0,0,0) */
} tap_window;

LANES_INLINE const unsigned char *window_row(const grid *grid, const tap_window *window, int y, int z) {
  return window->voxels + (size_t)z * grid->slice_bytes + (size_t)y * grid->row_bytes;
}

/* Adds up the weighted taps. The loops are not unrolled, because unrolled code would not fit the instruction
 * cache, and would take a compiler minutes. */
LANES_INLINE lanes sum_taps(const grid *grid, hl_storage storage, const tap_window *window,
                            const lanes weight[3][4]) {
  lanes sum = lanes_set(0);
  row_weights along = weights_of_row(storage, weight[0]);
#pragma GCC unroll 1
  for (int z = 0; z < 4; z++) {
    lanes plane = lanes_set(0);
#pragma GCC unroll 1
    for (int y = 0; y < 4; y++)
      plane = lanes_fma(sum_row(storage, window_row(grid, window, y, z), &window->offsets, &along),
                        weight[1][y], plane);
    sum = lanes_fma(plane, weight[2][z], sum);
  }
  return from_units(storage, sum);
}

static __attribute__((noinline)) lanes sum_u8(const grid *grid, const tap_window *window,
                                              const lanes weight[3][4]) {
  return sum_taps(grid, HL_STORAGE_U8, window, weight);
}
static __attribute__((noinline)) lanes sum_u16(const grid *grid, const tap_window *window,
                                               const lanes weight[3][4]) {
#ifdef HL_SHORT_ROWS
  return sum_short_rows(grid, window->voxels, &window->offsets, weight);
#else
  return sum_taps(grid, HL_STORAGE_U16, window, weight);
#endif
}
static __attribute__((noinline)) lanes sum_f32(const grid *grid, const tap_window *window,
                                               const lanes weight[3][4]) {
  return sum_taps(grid, HL_STORAGE_F32, window, weight);
}

/* Adds up the taps in the same order as sum_taps(), one lane at a time. This function is used for grids that
 * are less than four voxels thick along some axis. */
static __attribute__((noinline)) lanes sum_in_thin_grid(const grid *grid, const lanes_int cell[3],
                                                        uint32_t active, const lanes weight[3][4]) {
  lanes sums = lanes_set(0);
  for (; active != 0; active &= active - 1) {
    int lane = __builtin_ctz(active);
    int64_t x = cell[0][lane] - 1, y = cell[1][lane] - 1, z = cell[2][lane] - 1;
    float sum = 0;
    for (int c = 0; c < 4; c++) {
      float plane = 0;
      for (int b = 0; b < 4; b++) {
        float along[4];
        for (int a = 0; a < 4; a++)
          along[a] = hl_stored_value(grid, x + a, y + b, z + c) * weight[0][a][lane];
        plane = plane + ((along[0] + along[1]) + (along[2] + along[3])) * weight[1][b][lane];
      }
      sum = sum + plane * weight[2][c][lane];
    }
    sums[lane] = sum;
  }
  return sums;
}

/* Moves taps that lie outside the grid into the grid, along one axis. Outside the grid, the values at the
 * border continue. So the function adds the weights of outside taps to the border voxel's weight, and moves
 * the four taps inside. Only the cells -1, 0, n-2 and n-1 of n voxels have taps outside. Returns the moved
 * cells. */
LANES_INLINE lanes_int fold_border(lanes_int cell, int32_t count, lanes weight[4]) {
  lanes zero = lanes_set(0);
  lanes_int first = cell == -1, second = cell == 0, last_but_one = cell == count - 2,
            last = cell == count - 1;
  lanes w0 = weight[0], w1 = weight[1], w2 = weight[2], w3 = weight[3];
  weight[0] = lanes_select(first, w0 + w1 + w2,
                           lanes_select(second, w0 + w1, lanes_select(last | last_but_one, zero, w0)));
  weight[1] = lanes_select(
      first, w3, lanes_select(second, w2, lanes_select(last, zero, lanes_select(last_but_one, w0, w1))));
  weight[2] = lanes_select(
      first, zero, lanes_select(second, w3, lanes_select(last, w0, lanes_select(last_but_one, w1, w2))));
  weight[3] = lanes_select(first | second, zero,
                           lanes_select(last, w1 + w2 + w3, lanes_select(last_but_one, w2 + w3, w3)));
  lanes_int inside = lanes_select_int(cell < 1, lanes_set_int(1), cell);
  return lanes_select_int(inside > count - 3, lanes_set_int(count - 3), inside);
}

/* Finds the lanes whose taps all lie in the grid along an axis. */
LANES_INLINE uint32_t taps_inside(lanes_int cell, int32_t count) {
  return lanes_bits((cell >= 1) & (cell < count - 2));
}

/* Finds the axes along which some active lane has taps outside the grid; one bit for each axis. */
LANES_INLINE int axes_to_fold(const grid *grid, const lanes_int cell[3], uint32_t active) {
  int axes = 0;
  for (int a = 0; a < 3; a++) axes |= ((taps_inside(cell[a], grid->dimension[a]) & active) != active) << a;
  return axes;
}

/* The window (addresses of taps) of every lane. Offsets are counted from the first active lane's cell, so
 * that they fit 32 bits in any volume. Inactive lanes read the taps of the first active lane's cell. */
LANES_INLINE tap_window window_at(const grid *grid, const lanes_int cell[3], uint32_t active) {
  int first = __builtin_ctz(active);
  int32_t reference[3];
  for (int a = 0; a < 3; a++) reference[a] = cell[a][first];
  size_t bytes = hl_storage_bytes(grid->storage);
  tap_window window;
  window.voxels = hl_grid_row(grid, reference[1] - 1, reference[2] - 1) + (size_t)(reference[0] - 1) * bytes;
  lanes_int offset = (cell[2] - reference[2]) * (int32_t)grid->slice_bytes +
                     (cell[1] - reference[1]) * (int32_t)grid->row_bytes +
                     (cell[0] - reference[0]) * (int32_t)bytes;
  lanes_store_offsets(&window.offsets, offset & lanes_from_bits(active));
  return window;
}

/* The weighted sums of the taps, for voxels in memory. cell: tap 0 is at cell - 1; all taps of active lanes
 * lie in the grid. lowest: as in sum_of_windows(). */
LANES_INLINE lanes sum_in_memory(const grid *grid, const lanes_int cell[3], const int32_t *lowest,
                                 uint32_t active, const lanes weight[3][4]) {
#ifdef HL_WINDOWS
  lanes sum;
  if (sum_of_windows(grid, cell, lowest, active, weight, &sum)) return sum;
#else
  (void)lowest;
#endif
  tap_window window = window_at(grid, cell, active);
  if (grid->storage == HL_STORAGE_U8) return sum_u8(grid, &window, weight);
  if (grid->storage == HL_STORAGE_U16) return sum_u16(grid, &window, weight);
  return sum_f32(grid, &window, weight);
}

/* Makes *view, a grid that is a single page: the page that holds the taps of the first active lane. Returns
 * the active lanes whose taps lie in this page, one bit each. cell: tap 0 is at cell - 1. */
LANES_INLINE uint32_t lanes_in_page(const grid *grid, const lanes_int cell[3], uint32_t active,
                                    struct grid *view, hl_page_reading *reading) {
  int first = __builtin_ctz(active);
  lanes_int same = lanes_from_bits(active);
  size_t page[3];
  for (int a = 0; a < 3; a++) {
    lanes_int of_lane = (cell[a] - 1) >> grid->pages->shift;
    page[a] = (size_t)of_lane[first];
    same &= of_lane == of_lane[first];
  }
  hl_grid_of_page(grid, page, view, reading);
  return lanes_bits(same);
}

/* The weighted sums of the taps, for voxels in pages, page by page. The sums equal the sums for voxels in
 * memory, because no lane's sum depends on another lane. */
static __attribute__((noinline)) lanes sum_in_pages(const grid *grid, const lanes_int cell[3],
                                                    uint32_t active, const lanes weight[3][4]) {
  lanes sum = lanes_set(0);
  for (uint32_t left = active; left != 0;) {
    struct grid view;
    hl_page_reading reading;
    uint32_t in_page = lanes_in_page(grid, cell, left, &view, &reading);
    lanes some = sum_in_memory(&view, cell, NULL, in_page, weight);
    if (!hl_page_stayed(grid->pages, &reading)) continue;
    sum = lanes_select(lanes_from_bits(in_page), some, sum);
    left &= ~in_page;
  }
  return sum;
}

/* ---- fields in bricks ---- */

/* The lanes whose points lie in the same brick of a field in bricks, and the positions of these points in the
 * brick. */
typedef struct brick_lanes {
  const hl_brick_entry *entry;
  uint32_t bits;
  /* the cells that hold the points, at the brick's level. The brick's first cell has the number 1, so that
   * tap 0 is at cell - 1 of the coefficients that the brick stores */
  lanes_int cell[3];
  lanes part[3]; /* the position of each point between its cell's corners, 0 to 1 */
  float step;    /* the edge of a cell of level 0 divided by the edge of a cell of the brick's level: 1 or
                  * less */
} brick_lanes;

/* Finds the brick that holds the point of the first of the lanes `left`, and all lanes of `left` whose points
 * lie in this brick. cell, part: the cells of level 0 that hold the lanes' points, and the points' positions
 * in these cells. */
LANES_INLINE void lanes_in_brick(const hl_bricks *bricks, const lanes_int cell[3], const lanes part[3],
                                 uint32_t left, brick_lanes *found) {
  int first = __builtin_ctz(left);
  size_t block = 0;
  for (int a = 2; a >= 0; a--) {
    int32_t at = cell[a][first] >> bricks->shift, last = (int32_t)bricks->directory_size[a] - 1;
    at = at < 0      ? 0
         : at > last ? last
                     : at; /* clamped, so that the entry lies in the directory even if a ray's numbers are not
                            * finite */
    block = block * bricks->directory_size[a] + (size_t)at;
  }
  found->entry = &bricks->directory[block];
  int level = found->entry->level, shift = bricks->shift + level;
  int32_t below = (1 << level) - 1;
  lanes_int same = lanes_from_bits(left);
  found->step = 1.0f / (float)(1 << level);
  for (int a = 0; a < 3; a++) {
    same &= ((cell[a] ^ cell[a][first]) >> shift) == 0;
    found->cell[a] = ((cell[a] & ((1 << shift) - 1)) >> level) + 1;
    /* at level 0, the sum adds 0 and the factor is 1, so that no bit of `part` changes */
    found->part[a] = (lanes_from_int(cell[a] & below) + part[a]) * found->step;
  }
  found->bits = lanes_bits(same);
}

/* Makes *view, a grid of a brick's coefficients, for sum_in_memory(). Sets only the members that this
 * function reads. */
LANES_INLINE void grid_of_brick(const hl_bricks *bricks, const hl_brick_entry *entry, struct grid *view) {
  size_t width = ((size_t)1 << bricks->shift) + BRICK_MARGIN;
  view->voxels = bricks->pool + (size_t)entry->slot * width * width * width;
  view->row_bytes = width * sizeof *bricks->pool;
  view->slice_bytes = width * view->row_bytes;
  view->columns = NULL;
  view->storage = HL_STORAGE_F32;
  for (int a = 0; a < 3; a++) view->dimension[a] = (int32_t)width;
}

/* The weights of a brick's taps along an axis. A field of several levels has the B-spline's weights; a field
 * of one level has the weights of the scene's kernel. */
LANES_INLINE void weights_in_brick(const kernel *kernel, lanes part, lanes weight[4]) {
  if (kernel->degree == HL_BSPLINE_DEGREE) tap_weights(kernel, HL_BSPLINE_DEGREE, part, weight);
  else tap_weights(kernel, HL_KERNEL_DEGREE, part, weight);
}

/* Sums the weighted coefficients around sixteen positions of a field in bricks, brick by brick. In each
 * brick, sum_in_memory() finds the sums. cell, part: the cells of the grid that hold the positions, and the
 * positions' places in these cells. */
static __attribute__((noinline)) lanes sum_in_bricks(const grid *grid, const kernel *kernel,
                                                     const lanes_int cell[3], const lanes part[3],
                                                     uint32_t active) {
  const lanes_int at[3] = {cell[0] + 1, cell[1] + 1, cell[2] + 1};
  lanes sum = lanes_set(0);
  for (uint32_t left = active; left != 0;) {
    brick_lanes brick;
    lanes some;
    lanes_in_brick(grid->bricks, at, part, left, &brick);
    if (brick.entry->slot < 0) {
      some = lanes_set(brick.entry->constant);
    } else {
      struct grid view;
      lanes weight[3][4];
      grid_of_brick(grid->bricks, brick.entry, &view);
      for (int a = 0; a < 3; a++) weights_in_brick(kernel, brick.part[a], weight[a]);
      some = sum_in_memory(&view, brick.cell, NULL, brick.bits, (const lanes(*)[4])weight);
    }
    sum = lanes_select(lanes_from_bits(brick.bits), some, sum);
    left &= ~brick.bits;
  }
  return sum;
}

/* The weighted sums of the active lanes of a block. inside: whether all lanes are active and the taps of all
 * lanes lie in the grid. */
LANES_INLINE lanes gather_block(const fill_source *source, const block_points *points, uint32_t active,
                                int degree, int inside) {
  const grid *grid = source->grid;
  hl_storage storage = grid->storage;
  lanes weight[3][4];
  lanes_int cell[3] = {points->cell[0], points->cell[1], points->cell[2]};
  const lanes part[3] = {points->position.x - lanes_from_int(cell[0]),
                         points->position.y - lanes_from_int(cell[1]),
                         points->position.z - lanes_from_int(cell[2])};
  if (grid->bricks != NULL) return sum_in_bricks(grid, source->kernel, cell, part, active);
  for (int a = 0; a < 3; a++) tap_weights(source->kernel, degree, part[a], weight[a]);
  const lanes(*weights)[4] = (const lanes(*)[4])weight;
  int outside = inside ? 0 : axes_to_fold(grid, cell, active);
  if (outside != 0) {
    /* weights are rounded before the weights of taps outside the grid are added to others; splatting rounds
     * weights in this order, too */
    if (has_integer_weights(storage)) round_to_weights(weight[0]);
    if (grid->dimension[0] < 4 || grid->dimension[1] < 4 || grid->dimension[2] < 4)
      return sum_in_thin_grid(grid, cell, active, weights);
    for (int a = 0; a < 3; a++)
      if (outside >> a & 1) cell[a] = fold_border(cell[a], grid->dimension[a], weight[a]);
  }
  if (grid->pages != NULL) return sum_in_pages(grid, cell, active, weights);
  return sum_in_memory(grid, cell, inside ? points->low : NULL, active, weights);
}

/* Fills one block's densities. Returns whether any sample of the block may show something. */
LANES_INLINE int gather_points(const fill_source *source, const block_points *points, int inside,
                               float *density) {
  uint32_t active = inside ? 0xffff : lanes_bits(points->inside);
  lanes sum = lanes_set(0);
  if (active == 0) {
    lanes_store(density, sum);
    return 0;
  }
  sum = source->kernel->degree == HL_BSPLINE_DEGREE
            ? gather_block(source, points, active, HL_BSPLINE_DEGREE, inside)
            : gather_block(source, points, active, HL_KERNEL_DEGREE, inside);
  sum = sum - source->grid->empty;
  lanes_int shown = may_show(source, sum);
  if (!inside) {
    sum = lanes_keep(points->inside, sum);
    shown &= points->inside;
  }
  lanes_store(density, sum);
  return lanes_bits(shown) != 0;
}

LANES_INLINE block_points points_in_tile(const fill_source *source, int tile_x, int tile_y, int block,
                                         int inside) {
  int x = tile_x * TILE + block % 4 * BLOCK, y = tile_y * TILE + block / 4 * BLOCK;
  block_points points = inside ? find_points_inside(source, x, y) : find_points(source, x, y);
  lowest_of_block(points.cell, points.low);
  return points;
}

/* Fills the blocks in `need`, and the blocks in `others` whose cells may show something. All cells are tested
 * before any block is filled. If tests and sums alternated, the processor would mispredict branches, and
 * would begin sums that are not needed. inside: the result of tile_is_inside(). */
LANES_INLINE filled_blocks gather_blocks(const fill_source *source, int tile_x, int tile_y, uint32_t need,
                                         uint32_t others, int inside, float *density) {
  block_points points[TILE_BLOCKS];
  filled_blocks blocks = {need, 0};
  for (uint32_t left = others; left != 0; left &= left - 1) {
    int block = __builtin_ctz(left);
    points[block] = points_in_tile(source, tile_x, tile_y, block, inside);
    blocks.filled |= (uint32_t)cells_visible(source->grid, points[block].cell, points[block].low) << block;
  }
  for (uint32_t left = blocks.filled; left != 0; left &= left - 1) {
    int block = __builtin_ctz(left);
    if (need >> block & 1) points[block] = points_in_tile(source, tile_x, tile_y, block, inside);
    blocks.showing |= (uint32_t)gather_points(source, &points[block], inside, density + block * BLOCK_PIXELS)
                      << block;
  }
  return blocks;
}

static __attribute__((unused)) filled_blocks gather_tile(const fill_source *source, int tile_x, int tile_y,
                                                         uint32_t need, uint32_t others, float *density) {
  if (!source->grid->cell_bits_tell) need |= others, others = 0;
  if (tile_is_inside(source, tile_x * TILE, tile_y * TILE))
    return gather_blocks(source, tile_x, tile_y, need, others, 1, density);
  return gather_blocks(source, tile_x, tile_y, need, others, 0, density);
}

#endif
