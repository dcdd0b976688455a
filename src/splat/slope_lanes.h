/* splat/slope_lanes.h - the gradient of a volume's density at points of index space: the kernel's derivative along
 * each axis in turn, over the same 4x4x4 voxels that gathering weighs. */
#ifndef HL_SPLAT_SLOPE_LANES_H
#define HL_SPLAT_SLOPE_LANES_H

#include "splat/gather_lanes.h"

/* d/dt of a piece. */
LANES_INLINE lanes kernel_piece_slope(const float *piece, int degree, lanes a) {
  lanes sum = lanes_set(piece[degree] * (float)degree);
  for (int power = degree - 1; power >= 1; power--) sum = lanes_fma(sum, a, lanes_set(piece[power] * (float)power));
  return sum;
}

/* Derivatives of the four taps' weights; the two on the far side see their distance shrink. Their sum is 0. */
LANES_INLINE void tap_slopes(const kernel *kernel, int degree, lanes t, lanes slope[4]) {
  lanes s = 1.0f - t;
  int bspline = degree == HL_BSPLINE_DEGREE;
  slope[0] = bspline ? s * (s * -0.5f) : kernel_piece_slope(kernel->outer, degree, t);
  slope[1] = bspline ? t * lanes_line(t, 1.5f, -2.0f) : kernel_piece_slope(kernel->inner, degree, t);
  slope[3] = bspline ? t * (t * 0.5f) : -kernel_piece_slope(kernel->outer, degree, s);
  slope[2] = -(slope[0] + slope[1] + slope[3]);
}

typedef struct tap_slope_weights { lanes weight[3][4], slope[3][4]; } tap_slope_weights;

/* The three sums share the loads: along x once with the weights and once with their slopes. */
LANES_INLINE lanes3 sum_slopes(const grid *grid, hl_storage storage, const tap_window *window, const tap_slope_weights *w) {
  lanes3 sum = {lanes_set(0), lanes_set(0), lanes_set(0)};
  row_weights weights = weights_of_row(storage, w->weight[0]);
  row_slopes slopes = slopes_of_row(storage, w->slope[0]);
#pragma GCC unroll 1
  for (int z = 0; z < 4; z++) {
    lanes value = lanes_set(0), along_x = value, along_y = value;
#pragma GCC unroll 1
    for (int y = 0; y < 4; y++) {
      const unsigned char *row = window_row(grid, storage, window, y, z);
      lanes plain = sum_row(storage, row, &window->offsets, &weights);
      along_x = lanes_fma(slope_row(storage, row, &window->offsets, &slopes), w->weight[1][y], along_x);
      along_y = lanes_fma(plain, w->slope[1][y], along_y);
      value = lanes_fma(plain, w->weight[1][y], value);
    }
    sum.x = lanes_fma(along_x, w->weight[2][z], sum.x);
    sum.y = lanes_fma(along_y, w->weight[2][z], sum.y);
    sum.z = lanes_fma(value, w->slope[2][z], sum.z);
  }
  if (storage != HL_STORAGE_U8) return sum;
  return (lanes3){sum.x * SLOPE_INVERSE, sum.y * WEIGHT_INVERSE, sum.z * WEIGHT_INVERSE};
}

/* Without the last block's lanes. */
LANES_INLINE uint32_t drop_last_block(uint32_t active, uint32_t starts) {
  uint32_t below = (2u << (31 - __builtin_clz(active))) - 1; /* up to the last lane */
  return active & ((1u << (31 - __builtin_clz(starts & below))) - 1);
}

/* The lanes with a bit are part's. */
LANES_INLINE void join_slopes(uint32_t bits, lanes3 part, lanes3 *slope) {
  lanes_int mask = lanes_from_bits(bits);
  *slope = (lanes3){lanes_select(mask, part.x, slope->x), lanes_select(mask, part.y, slope->y),
                    lanes_select(mask, part.z, slope->z)};
}

#if defined(__AVX512BW__)
LANES_INLINE lanes3 slopes_of_own_slices(hl_storage storage, const voxel_window *window, int spread, const tap_slope_weights *w) {
  own_slices own;
  window_taps taps[4];
  row_weights weights = weights_of_row(storage, w->weight[0]);
  row_slopes slopes = slopes_of_row(storage, w->slope[0]);
  lanes none = lanes_set(0), value[4] = {none, none, none, none}, along_x[4] = {none, none, none, none}, along_y[4] = {none, none, none, none};
  lanes3 sum = {none, none, none};
  load_own_slices(storage, window, spread, &own);
  for (int y = 0; y < 4; y++) {
    own_taps(storage, &own, spread, window->index, y, taps);
    for (int z = 0; z < 4; z++) {
      lanes plain = weigh_taps(storage, &taps[z], &weights);
      along_x[z] = lanes_fma(slope_of_taps(storage, &taps[z], &slopes), w->weight[1][y], along_x[z]);
      along_y[z] = lanes_fma(plain, w->slope[1][y], along_y[z]);
      value[z] = lanes_fma(plain, w->weight[1][y], value[z]);
    }
  }
  for (int z = 0; z < 4; z++) {
    sum.x = lanes_fma(along_x[z], w->weight[2][z], sum.x);
    sum.y = lanes_fma(along_y[z], w->weight[2][z], sum.y);
    sum.z = lanes_fma(value[z], w->slope[2][z], sum.z);
  }
  if (storage != HL_STORAGE_U8) return sum;
  return (lanes3){sum.x * SLOPE_INVERSE, sum.y * WEIGHT_INVERSE, sum.z * WEIGHT_INVERSE};
}

LANES_INLINE lanes3 slopes_of_slices(hl_storage storage, const voxel_window *window, const tap_slope_weights *w) {
  switch (window->slices - 4) {
    case 0: return slopes_of_own_slices(storage, window, 0, w);
    case 1: return slopes_of_own_slices(storage, window, 1, w);
    case 2: return slopes_of_own_slices(storage, window, 2, w);
    case 3: return slopes_of_own_slices(storage, window, 3, w);
    default: return slopes_of_own_slices(storage, window, WINDOW_SPREAD, w);
  }
}

static __attribute__((noinline)) lanes3 slopes_of_window_u8(const voxel_window *window, const tap_slope_weights *w) {
  return slopes_of_slices(HL_STORAGE_U8, window, w);
}
static __attribute__((noinline)) lanes3 slopes_of_window_u16(const voxel_window *window, const tap_slope_weights *w) {
  return slopes_of_slices(HL_STORAGE_U16, window, w);
}
static __attribute__((noinline)) lanes3 slopes_of_window_f32(const voxel_window *window, const tap_slope_weights *w) {
  lanes3 sum = {lanes_set(0), lanes_set(0), lanes_set(0)};
  for (int slice = 0; slice < window->slices; slice++) {
    window_slice voxels = slice_of_window(HL_STORAGE_F32, window, slice);
    lanes value = lanes_set(0), along_x = value, along_y = value;
    for (int y = 0; y < 4; y++) {
      window_taps taps = taps_f32(&voxels, window->index, y);
      lanes plain = weigh_f32(&taps, w->weight[0]);
      along_x = lanes_fma(weigh_f32(&taps, w->slope[0]), w->weight[1][y], along_x);
      along_y = lanes_fma(plain, w->slope[1][y], along_y);
      value = lanes_fma(plain, w->weight[1][y], value);
    }
    lanes weight = weight_of_slice(window, slice, w->weight[2]);
    sum.x = lanes_fma(along_x, weight, sum.x);
    sum.y = lanes_fma(along_y, weight, sum.y);
    sum.z = lanes_fma(value, weight_of_slice(window, slice, w->slope[2]), sum.z);
  }
  return sum;
}
/* As many blocks to a window as fit. False where even one does not. */
static int slopes_of_windows(const grid *grid, const lanes_int cell[3], uint32_t active, uint32_t starts,
                             const tap_slope_weights *w, lanes3 *slope) {
  voxel_window window;
  for (uint32_t left = active; left != 0;) {
    uint32_t together = left;
    while (!open_window(grid, cell, together, &window))
      if ((together = drop_last_block(together, starts)) == 0) return 0;
    lanes3 part = grid->storage == HL_STORAGE_U8    ? slopes_of_window_u8(&window, w)
                  : grid->storage == HL_STORAGE_U16 ? slopes_of_window_u16(&window, w)
                                                    : slopes_of_window_f32(&window, w);
    if (together == active) {
      *slope = part;
      return 1;
    }
    join_slopes(together, part, slope);
    left &= ~together;
  }
  return 1;
}

#elif defined(HL_WINDOWS)
static __attribute__((noinline)) lanes3 slopes_of_copies(const window_copies *copies, lanes_int taps_at, const tap_slope_weights *w) {
  lanes_offsets offsets;
  __m256 sums[3][2];
  row_weights weights = weights_of_row(HL_STORAGE_U8, w->weight[0]);
  row_slopes slopes = slopes_of_row(HL_STORAGE_U8, w->slope[0]);
  lanes_store_offsets(&offsets, taps_at);
#pragma GCC unroll 1
  for (int half = 0; half < 2; half++) {
    __m256i plain_of_two[4][4], slope_of_two[4][4];
    __m256 x = _mm256_setzero_ps(), y = x, z = x;
    for (int k = 0; k < 4; k++) {
      pair_of_taps taps = taps_of_pair(copies, &offsets, half, k);
      weights_of_two along = weights_of_pair(&weights.bytes, half, k);
      slopes_of_two slope = slopes_of_pair(&slopes.bytes, half, k);
      for (int slice = 0; slice < 4; slice++) {
        taps_of_two of_slice = slice_of_two(&taps, slice);
        plain_of_two[slice][k] = weigh_two(&of_slice, &along);
        slope_of_two[slice][k] = multiply_two(&of_slice, slope.pair);
      }
    }
    for (int slice = 0; slice < 4; slice++) {
      __m256 plain[4], sloped[4], weight = half_of(&w->weight[2][slice], half);
      turn_rows(plain_of_two[slice], plain);
      turn_rows(slope_of_two[slice], sloped);
      x = _mm256_fmadd_ps(add_rows(sloped, w->weight[1], half), weight, x);
      y = _mm256_fmadd_ps(add_rows(plain, w->slope[1], half), weight, y);
      z = _mm256_fmadd_ps(add_rows(plain, w->weight[1], half), half_of(&w->slope[2][slice], half), z);
    }
    sums[0][half] = _mm256_mul_ps(x, _mm256_set1_ps(SLOPE_INVERSE));
    sums[1][half] = _mm256_mul_ps(y, _mm256_set1_ps(WEIGHT_INVERSE));
    sums[2][half] = _mm256_mul_ps(z, _mm256_set1_ps(WEIGHT_INVERSE));
  }
  lanes3 sum;
  memcpy(&sum, sums, sizeof sum);
  return sum;
}

/* As many blocks to a window as fit, and all windows' copies to one sum. False where even one block does not fit. */
static int slopes_of_windows(const grid *grid, const lanes_int cell[3], uint32_t active, uint32_t starts,
                             const tap_slope_weights *w, lanes3 *slope) {
  window_copies copies[LANES];
  voxel_window window;
  lanes_int taps = lanes_set_int(0);
  int count = 0;
  for (uint32_t left = active; left != 0;) {
    uint32_t together = left;
    while (!open_window(grid, cell, together, &window))
      if ((together = drop_last_block(together, starts)) == 0) return 0;
    copy_window(&window, &copies[count]);
    taps = lanes_select_int(lanes_from_bits(together), window.taps + count++ * (int32_t)sizeof copies[0], taps);
    left &= ~together;
  }
  *slope = slopes_of_copies(copies, taps, w);
  return 1;
}
#endif

static __attribute__((noinline)) lanes3 slopes_u8(const grid *grid, const tap_window *window, const tap_slope_weights *w) {
  return sum_slopes(grid, HL_STORAGE_U8, window, w);
}
static __attribute__((noinline)) lanes3 slopes_u16(const grid *grid, const tap_window *window, const tap_slope_weights *w) {
  return sum_slopes(grid, HL_STORAGE_U16, window, w);
}
static __attribute__((noinline)) lanes3 slopes_f32(const grid *grid, const tap_window *window, const tap_slope_weights *w) {
  return sum_slopes(grid, HL_STORAGE_F32, window, w);
}

static lanes3 slopes_of_taps(const grid *grid, const lanes_int cell[3], uint32_t active, const tap_slope_weights *w) {
  tap_window window = window_at(grid, cell, active);
  if (grid->storage == HL_STORAGE_U8) return slopes_u8(grid, &window, w);
  if (grid->storage == HL_STORAGE_U16) return slopes_u16(grid, &window, w);
  return slopes_f32(grid, &window, w);
}

/* Whether 32 bits hold the offsets between any two voxels; in larger grids they hold those within a block. */
LANES_INLINE int fits_offsets(const grid *grid) {
  return (uint64_t)grid->dimension[0] * (uint64_t)grid->dimension[1] * (uint64_t)grid->dimension[2] *
             hl_storage_bytes(grid->storage) <= INT32_MAX;
}

static lanes3 slopes_in_thin_grid(const grid *grid, const lanes_int cell[3], uint32_t active, const tap_slope_weights *w) {
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

/* Derivatives along the index axes, stored units a voxel, for the active lanes, of which there is one at least.
 * starts: the lanes at which those of one block of pixels follow those of another, the first included. */
LANES_INLINE lanes3 slopes_of_degree(const grid *grid, const kernel *kernel, int degree, lanes3 point, uint32_t active,
                                     uint32_t starts) {
  tap_slope_weights w;
  lanes_int cell[3];
  lanes at[3] = {point.x, point.y, point.z};
  for (int a = 0; a < 3; a++) {
    at[a] = lanes_clamp(at[a], -1.0f, (float)grid->dimension[a] * (1 - 1e-6f));
    cell[a] = lanes_floor(at[a]);
    tap_weights(kernel, degree, at[a] - lanes_from_int(cell[a]), w.weight[a]);
    tap_slopes(kernel, degree, at[a] - lanes_from_int(cell[a]), w.slope[a]);
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
#ifdef HL_WINDOWS
  lanes3 slope = {lanes_set(0), lanes_set(0), lanes_set(0)};
  if (slopes_of_windows(grid, cell, active, starts, &w, &slope)) return slope;
#endif
  if (fits_offsets(grid)) return slopes_of_taps(grid, cell, active, &w);
  lanes3 sum = {lanes_set(0), lanes_set(0), lanes_set(0)};
  for (uint32_t left = active; left != 0;) {
    uint32_t block = left;
    for (uint32_t less = drop_last_block(left, starts); less != 0; less = drop_last_block(less, starts)) block = less;
    join_slopes(block, slopes_of_taps(grid, cell, block, &w), &sum);
    left &= ~block;
  }
  return sum;
}

static lanes3 slopes_at(const grid *grid, const kernel *kernel, lanes3 point, uint32_t active, uint32_t starts) {
  return kernel->degree == HL_BSPLINE_DEGREE ? slopes_of_degree(grid, kernel, HL_BSPLINE_DEGREE, point, active, starts)
                                             : slopes_of_degree(grid, kernel, HL_KERNEL_DEGREE, point, active, starts);
}

#endif
