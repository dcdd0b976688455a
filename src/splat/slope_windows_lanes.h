/* splat/slope_windows_lanes.h - gradients through windows of voxels (window_lanes.h). */
#ifndef HL_SPLAT_SLOPE_WINDOWS_LANES_H
#define HL_SPLAT_SLOPE_WINDOWS_LANES_H

#include "splat/gather_lanes.h"

/* Of the 64 taps, along each axis. */
typedef struct tap_slope_weights { lanes weight[3][4], slope[3][4]; } tap_slope_weights;

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

LANES_INLINE lanes3 slopes_of_window(hl_storage storage, const voxel_window *window, const tap_slope_weights *w) {
  switch (window->slices - 4) {
    case 0: return slopes_of_own_slices(storage, window, 0, w);
    case 1: return slopes_of_own_slices(storage, window, 1, w);
    case 2: return slopes_of_own_slices(storage, window, 2, w);
    case 3: return slopes_of_own_slices(storage, window, 3, w);
    default: return slopes_of_own_slices(storage, window, WINDOW_SPREAD, w);
  }
}

static __attribute__((noinline)) lanes3 slopes_of_window_u8(const voxel_window *window, const tap_slope_weights *w) {
  return slopes_of_window(HL_STORAGE_U8, window, w);
}
static __attribute__((noinline)) lanes3 slopes_of_window_u16(const voxel_window *window, const tap_slope_weights *w) {
  return slopes_of_window(HL_STORAGE_U16, window, w);
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

#endif
