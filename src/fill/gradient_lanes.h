/* fill/gradient_lanes.h - finds the gradient of a volume's density at points of index space. Each component
 * of the gradient is a sum over the 4x4x4 voxels around the point, weighted by the kernel's derivative along
 * one axis and by the kernel along the other two axes. */
#ifndef HL_FILL_GRADIENT_LANES_H
#define HL_FILL_GRADIENT_LANES_H

#include "fill/gather_lanes.h"

/* Sums the three components of the gradient. The three sums share the loads of voxels. Each row of voxels is
 * summed twice: once with the weights along x, and once with the slopes, which are the weights' derivatives.
 */
LANES_INLINE lanes3 sum_slopes(const grid *grid, hl_storage storage, const tap_window *window,
                               const tap_slope_weights *w) {
  lanes3 sum = {lanes_set(0), lanes_set(0), lanes_set(0)};
  row_weights weights = weights_of_row(storage, w->weight[0]);
  row_slopes slopes = slopes_of_row(storage, w->slope[0]);
#pragma GCC unroll 1
  for (int z = 0; z < 4; z++) {
    lanes value = lanes_set(0), along_x = value, along_y = value;
#pragma GCC unroll 1
    for (int y = 0; y < 4; y++) {
      const unsigned char *row = window_row(grid, window, y, z);
      lanes plain = sum_row(storage, row, &window->offsets, &weights);
      along_x = lanes_fma(slope_row(storage, row, &window->offsets, &slopes), w->weight[1][y], along_x);
      along_y = lanes_fma(plain, w->slope[1][y], along_y);
      value = lanes_fma(plain, w->weight[1][y], value);
    }
    sum.x = lanes_fma(along_x, w->weight[2][z], sum.x);
    sum.y = lanes_fma(along_y, w->weight[2][z], sum.y);
    sum.z = lanes_fma(value, w->slope[2][z], sum.z);
  }
  return (lanes3){from_slope_units(storage, sum.x), from_units(storage, sum.y), from_units(storage, sum.z)};
}

static __attribute__((noinline)) lanes3 slopes_u8(const grid *grid, const tap_window *window,
                                                  const tap_slope_weights *w) {
  return sum_slopes(grid, HL_STORAGE_U8, window, w);
}
static __attribute__((noinline)) lanes3 slopes_u16(const grid *grid, const tap_window *window,
                                                   const tap_slope_weights *w) {
#ifdef HL_SHORT_ROWS
  return slopes_of_short_rows(grid, window->voxels, &window->offsets, w);
#else
  return sum_slopes(grid, HL_STORAGE_U16, window, w);
#endif
}
static __attribute__((noinline)) lanes3 slopes_f32(const grid *grid, const tap_window *window,
                                                   const tap_slope_weights *w) {
  return sum_slopes(grid, HL_STORAGE_F32, window, w);
}

static lanes3 slopes_of_taps(const grid *grid, const lanes_int cell[3], uint32_t active,
                             const tap_slope_weights *w) {
  tap_window window = window_at(grid, cell, active);
  if (grid->storage == HL_STORAGE_U8) return slopes_u8(grid, &window, w);
  if (grid->storage == HL_STORAGE_U16) return slopes_u16(grid, &window, w);
  return slopes_f32(grid, &window, w);
}

/* Returns whether 32 bits hold the offset between any two voxels of a grid. In larger grids, 32 bits still
 * hold the offsets between the voxels that the points of one block of pixels need. */
LANES_INLINE int fits_offsets(const grid *grid) {
  return (uint64_t)grid->dimension[2] * grid->slice_bytes <= INT32_MAX;
}

static lanes3 slopes_in_thin_grid(const grid *grid, const lanes_int cell[3], uint32_t active,
                                  const tap_slope_weights *w) {
  lanes3 slope;
  lanes *sums[3] = {&slope.x, &slope.y, &slope.z};
  for (int axis = 0; axis < 3; axis++) {
    lanes weight[3][4];
    for (int a = 0; a < 3; a++)
      for (int tap = 0; tap < 4; tap++) weight[a][tap] = a == axis ? w->slope[a][tap] : w->weight[a][tap];
    *sums[axis] = sum_in_thin_grid(grid, cell, active, (const lanes(*)[4])weight);
  }
  return slope;
}

/* The gradient's components, for voxels in memory. cell: tap 0 is at cell - 1; all taps of active lanes lie
 * in the grid. */
LANES_INLINE lanes3 slopes_in_memory(const grid *grid, const lanes_int cell[3], uint32_t active,
                                     uint32_t starts, const tap_slope_weights *w) {
  lanes3 sum = {lanes_set(0), lanes_set(0), lanes_set(0)};
#ifdef HL_WINDOWS
  if (slopes_of_windows(grid, cell, active, starts, w, &sum)) return sum;
  sum = (lanes3){lanes_set(0), lanes_set(0), lanes_set(0)};
#endif
  if (fits_offsets(grid)) return slopes_of_taps(grid, cell, active, w);
  for (uint32_t left = active; left != 0;) {
    uint32_t block = left;
    for (uint32_t less = drop_last_block(left, starts); less != 0; less = drop_last_block(less, starts))
      block = less;
    join_slopes(block, slopes_of_taps(grid, cell, block, w), &sum);
    left &= ~block;
  }
  return sum;
}

/* The gradient's components, for voxels in pages, page by page. */
static __attribute__((noinline)) lanes3 slopes_in_pages(const grid *grid, const lanes_int cell[3],
                                                        uint32_t active, uint32_t starts,
                                                        const tap_slope_weights *w) {
  lanes3 sum = {lanes_set(0), lanes_set(0), lanes_set(0)};
  for (uint32_t left = active; left != 0;) {
    struct grid view;
    hl_page_reading reading;
    uint32_t in_page = lanes_in_page(grid, cell, left, &view, &reading);
    lanes3 some = slopes_in_memory(&view, cell, in_page, starts, w);
    if (!hl_page_stayed(grid->pages, &reading)) continue;
    join_slopes(in_page, some, &sum);
    left &= ~in_page;
  }
  return sum;
}

/* The gradient's components, for a field in bricks, brick by brick. The parameters are the same as for
 * sum_in_bricks(). */
static __attribute__((noinline)) lanes3 slopes_in_bricks(const grid *grid, const kernel *kernel,
                                                         const lanes_int cell[3], const lanes part[3],
                                                         uint32_t active, uint32_t starts) {
  const lanes_int at[3] = {cell[0] + 1, cell[1] + 1, cell[2] + 1};
  lanes3 sum = {lanes_set(0), lanes_set(0), lanes_set(0)};
  for (uint32_t left = active; left != 0;) {
    brick_lanes brick;
    lanes_in_brick(grid->bricks, at, part, left, &brick);
    left &= ~brick.bits;
    if (brick.entry->slot < 0) continue;
    struct grid view;
    tap_slope_weights w;
    grid_of_brick(grid->bricks, brick.entry, &view);
    for (int a = 0; a < 3; a++) {
      weights_in_brick(kernel, brick.part[a], w.weight[a]);
      if (kernel->degree == HL_BSPLINE_DEGREE)
        tap_slopes(kernel, HL_BSPLINE_DEGREE, brick.part[a], w.slope[a]);
      else tap_slopes(kernel, HL_KERNEL_DEGREE, brick.part[a], w.slope[a]);
      for (int tap = 0; tap < 4; tap++) w.slope[a][tap] = w.slope[a][tap] * brick.step;
    }
    join_slopes(brick.bits, slopes_in_memory(&view, brick.cell, brick.bits, starts, &w), &sum);
  }
  return sum;
}

/* The derivatives of the density along the index axes, in stored units per voxel, for the active lanes. At
 * least one lane must be active. starts: the first lane of each block of pixels, one bit each. */
LANES_INLINE lanes3 slopes_of_degree(const grid *grid, const kernel *kernel, int degree, lanes3 point,
                                     uint32_t active, uint32_t starts) {
  tap_slope_weights w;
  lanes_int cell[3];
  lanes at[3] = {point.x, point.y, point.z}, part[3];
  for (int a = 0; a < 3; a++) {
    at[a] = lanes_clamp(at[a], -1.0f, (float)grid->dimension[a] * (1 - 1e-6f));
    cell[a] = lanes_floor(at[a]);
    part[a] = at[a] - lanes_from_int(cell[a]);
  }
  if (grid->bricks != NULL) return slopes_in_bricks(grid, kernel, cell, part, active, starts);
  for (int a = 0; a < 3; a++) {
    tap_weights(kernel, degree, part[a], w.weight[a]);
    tap_slopes(kernel, degree, part[a], w.slope[a]);
  }
  int outside = axes_to_fold(grid, cell, active);
  if (outside != 0) {
    if (grid->dimension[0] < 4 || grid->dimension[1] < 4 || grid->dimension[2] < 4)
      return slopes_in_thin_grid(grid, cell, active, &w);
    for (int a = 0; a < 3; a++) {
      if ((outside >> a & 1) == 0) continue;
      (void)fold_border(cell[a], grid->dimension[a], w.slope[a]);
      cell[a] = fold_border(cell[a], grid->dimension[a], w.weight[a]);
    }
  }
  if (grid->pages != NULL) return slopes_in_pages(grid, cell, active, starts, &w);
  return slopes_in_memory(grid, cell, active, starts, &w);
}

static lanes3 slopes_at(const grid *grid, const kernel *kernel, lanes3 point, uint32_t active,
                        uint32_t starts) {
  return kernel->degree == HL_BSPLINE_DEGREE
             ? slopes_of_degree(grid, kernel, HL_BSPLINE_DEGREE, point, active, starts)
             : slopes_of_degree(grid, kernel, HL_KERNEL_DEGREE, point, active, starts);
}

#endif
