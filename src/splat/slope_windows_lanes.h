/* splat/slope_windows_lanes.h - gradients through windows of voxels (window_lanes.h). */
#ifndef HL_SPLAT_SLOPE_WINDOWS_LANES_H
#define HL_SPLAT_SLOPE_WINDOWS_LANES_H

#include "splat/gather_lanes.h"

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
LANES_INLINE lanes3 slopes_of_own_slices(hl_storage storage, const voxel_window *window, int spread,
                                         const tap_slope_weights *w) {
  own_slices own;
  window_taps taps[4];
  row_weights weights = weights_of_row(storage, w->weight[0]);
  row_slopes slopes = slopes_of_row(storage, w->slope[0]);
  lanes none = lanes_set(0), value[4] = {none, none, none, none}, along_x[4] = {none, none, none, none},
        along_y[4] = {none, none, none, none};
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
  return (lanes3){from_slope_units(storage, sum.x), from_units(storage, sum.y), from_units(storage, sum.z)};
}

LANES_INLINE lanes3 slopes_of_window(hl_storage storage, const voxel_window *window,
                                     const tap_slope_weights *w) {
  switch (window->slices - 4) {
    case 0: return slopes_of_own_slices(storage, window, 0, w);
    case 1: return slopes_of_own_slices(storage, window, 1, w);
    case 2: return slopes_of_own_slices(storage, window, 2, w);
    case 3: return slopes_of_own_slices(storage, window, 3, w);
    default: return slopes_of_own_slices(storage, window, WINDOW_SPREAD, w);
  }
}

static __attribute__((noinline)) lanes3 slopes_of_window_u8(const voxel_window *window,
                                                            const tap_slope_weights *w) {
  return slopes_of_window(HL_STORAGE_U8, window, w);
}
static __attribute__((noinline)) lanes3 slopes_of_window_u16(const voxel_window *window,
                                                             const tap_slope_weights *w) {
  return slopes_of_window(HL_STORAGE_U16, window, w);
}
static __attribute__((noinline)) lanes3 slopes_of_window_f32(const voxel_window *window,
                                                             const tap_slope_weights *w) {
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
  if (!has_windows(grid)) return 0;
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
static __attribute__((noinline)) lanes3 slopes_of_copies(const window_copies *copies, __m256i taps_at,
                                                         const tap_slope_weights *w) {
  narrow_offsets offsets;
  lanes3 sum;
  row_weights weights = weights_of_row(HL_STORAGE_U8, w->weight[0]);
  row_slopes slopes = slopes_of_row(HL_STORAGE_U8, w->slope[0]);
  narrow_store(&offsets, taps_at);
#pragma GCC unroll 1
  for (int half = 0; half < 2; half++) {
    sums_of_rows plain, sloped;
    for (int k = 0; k < 4; k++) {
      pair_of_taps taps = copied_taps_of_pair(copies, &offsets, half, k);
      weights_of_two along = weights_of_pair(&weights.bytes, half, k),
                     slope = weights_of_pair(&slopes.bytes, half, k);
      for (int z = 0; z < 4; z++) {
        taps_of_two of_slice = slice_of_two(&taps, z);
        plain.of_two[z][k] = weigh_two(&of_slice, &along);
        sloped.of_two[z][k] = weigh_two(&of_slice, &slope);
      }
    }
    store_half(add_slopes(&plain, &sloped, w, half), half, &sum);
  }
  return sum;
}

_Static_assert(LANES * sizeof(window_copies) <= INT16_MAX,
               "16 bits with a sign hold places in all windows' copies");

/* As many blocks to a window as fit, and all windows' copies to one sum. False where even one block does not
 * fit. */
static int slopes_of_windows(const grid *grid, const lanes_int cell[3], uint32_t active, uint32_t starts,
                             const tap_slope_weights *w, lanes3 *slope) {
  window_copies copies[LANES];
  voxel_window window;
  __m256i taps = _mm256_setzero_si256();
  int count = 0;
  if (!has_windows(grid)) return 0;
  for (uint32_t left = active; left != 0;) {
    uint32_t together = left;
    while (!open_window(grid, cell, together, &window))
      if ((together = drop_last_block(together, starts)) == 0) return 0;
    copy_window(&window, &copies[count]);
    __m256i in_copy = _mm256_add_epi16(window.taps,
                                       _mm256_set1_epi16((short)(count++ * (int)sizeof copies[0])));
    taps = _mm256_blendv_epi8(taps, in_copy, narrow_shorts(lanes_from_bits(together)));
    left &= ~together;
  }
  *slope = slopes_of_copies(copies, taps, w);
  return 1;
}
#endif

#endif
