/* fill/windows_avx512_lanes.h - sums over windows of voxels in registers of 512 bits (windows_lanes.h). */
#ifndef HL_FILL_WINDOWS_AVX512_LANES_H
#define HL_FILL_WINDOWS_AVX512_LANES_H

#include "fill/block_lanes.h"

#if defined(HL_PERMUTES_BYTES)
#include "fill/window_bytes_avx512_vbmi_lanes.h"
#else
#include "fill/window_words_avx512_lanes.h"
#endif

enum {
  WINDOW_SIDE = GRID_COLUMN,      /* width of a window, in voxels */
  WINDOW_SPREAD = WINDOW_SIDE - 4 /* the greatest distance, in voxels, between the first taps of two lanes of
                                   * a window */
};

typedef struct voxel_window {
  const unsigned char *first; /* the address of the window's first row; for u8 voxels, the row's address in a
                               * column */
  size_t row_bytes, slice_bytes;
  /* for u8 voxels: number of bytes from the column to the next column; 0 if the window lies within one
   * column */
  size_t beside;
  __m512i shift; /* for u8 voxels: bits from the column's first voxel to the window's first voxel, in every
                  * row */
  __m512i index; /* index of each lane's taps in tap row 0, counted in a slice of the window */
  __m512i start; /* the window's slice that holds each lane's first tap; 0 for inactive lanes */
  int slices;
} voxel_window;

/* The least cell of the active lanes along each axis. */
LANES_INLINE void lowest_of_lanes(const lanes_int cell[3], uint32_t active, int32_t low[3]) {
  for (int a = 0; a < 3; a++) low[a] = _mm512_mask_reduce_min_epi32((__mmask16)active, (__m512i)cell[a]);
}

LANES_INLINE __m512i window_index(hl_storage storage, const __m512i offset[3]) {
  return storage == HL_STORAGE_U8    ? index_u8(offset[0], offset[1])
         : storage == HL_STORAGE_U16 ? index_u16(offset[0], offset[1])
                                     : index_f32(offset[0], offset[1]);
}

/* Sets the members that tell where the window begins in memory. low: the coordinates of the window's first
 * voxel. */
LANES_INLINE void locate_window(const grid *grid, const int32_t low[3], voxel_window *window) {
  if (grid->storage == HL_STORAGE_U8) {
    int32_t within = low[0] % GRID_COLUMN;
    window->slice_bytes = grid->column_slice_bytes;
    window->first = grid->columns + (size_t)(low[0] / GRID_COLUMN) * grid->column_bytes +
                    (size_t)low[2] * grid->column_slice_bytes + (size_t)low[1] * GRID_COLUMN;
    window->beside = within > GRID_COLUMN - WINDOW_WIDTH ? grid->column_bytes : 0;
    window->shift = _mm512_set1_epi64(within * 8);
  } else {
    size_t voxel = hl_storage_bytes(grid->storage);
    window->row_bytes = grid->row_bytes;
    window->slice_bytes = grid->slice_bytes;
    window->first = hl_grid_row(grid, low[1], low[2]) + (size_t)low[0] * voxel;
  }
}

/* Returns whether windows of voxels can be opened in a grid. */
LANES_INLINE int has_windows(const grid *grid) {
  if (grid->storage == HL_STORAGE_U8) return grid->columns != NULL;
  return grid->dimension[0] >= WINDOW_SIDE && grid->dimension[1] >= WINDOW_SIDE;
}

/* Opens a window of voxels in a grid that has windows. cell: tap 0 is at cell - 1; all taps of active lanes
 * lie in the grid. lowest: the least of the active lanes' cells along each axis. Returns false if the taps do
 * not fit a window. */
LANES_INLINE int open_window_at(const grid *grid, const lanes_int cell[3], const int32_t lowest[3],
                                uint32_t active, voxel_window *window) {
  __mmask16 lanes_mask = (__mmask16)active, fits = (__mmask16)active;
  const int32_t side[3] = {grid->storage == HL_STORAGE_U8 ? WINDOW_WIDTH : WINDOW_SIDE,
                           grid->storage == HL_STORAGE_U8 ? WINDOW_SIDE : WINDOW_ROWS, WINDOW_SIDE};
  int32_t low[3];
  __m512i offset[3];
  for (int a = 0; a < 3; a++) {
    low[a] = lowest[a] - 1;
    if (a < 2 && low[a] > grid->dimension[a] - side[a]) low[a] = grid->dimension[a] - side[a];
    offset[a] = _mm512_maskz_sub_epi32(lanes_mask, (__m512i)cell[a], _mm512_set1_epi32(low[a] + 1));
    fits = _mm512_mask_cmple_epu32_mask(fits, offset[a], _mm512_set1_epi32(side[a] - 4));
  }
  if (fits != lanes_mask) return 0;
  window->start = offset[2];
  window->slices = 4 + _mm512_reduce_max_epi32(offset[2]);
  window->index = window_index(grid->storage, offset);
  locate_window(grid, low, window);
  return 1;
}

LANES_INLINE int open_window(const grid *grid, const lanes_int cell[3], uint32_t active,
                             voxel_window *window) {
  int32_t lowest[3];
  if (active == 0) return 0;
  lowest_of_lanes(cell, active, lowest);
  return open_window_at(grid, cell, lowest, active, window);
}

LANES_INLINE window_slice slice_of_window(hl_storage storage, const voxel_window *window, int slice) {
  const unsigned char *first = window->first + (size_t)slice * window->slice_bytes;
  if (storage == HL_STORAGE_U8)
    return join_columns(_mm512_loadu_si512(first), _mm512_loadu_si512(first + window->beside), window->shift);
  return storage == HL_STORAGE_U16 ? slice_u16(first, window->row_bytes)
                                   : slice_f32(first, window->row_bytes);
}

/* ---- u8 and u16: each lane's own four slices ---- */

/* Slices of a window. Each lane takes its taps from four slices: a lane whose first tap lies in slice s takes
 * the taps of tap slice z from slice s + z, where s is at most `spread`. For each tap row y and each z, the
 * taps of all lanes are collected first and then weighted once. Collecting needs fewer sums than one sum for
 * each slice of the window. */
typedef struct own_slices {
  window_slice voxels[WINDOW_SIDE];
  window_lanes later[WINDOW_SPREAD + 1]; /* element s: the lanes whose first tap lies in slice s of the
                                          * window */
} own_slices;

LANES_INLINE void load_own_slices(hl_storage storage, const voxel_window *window, int spread,
                                  own_slices *own) {
  for (int slice = 0; slice < spread + 4; slice++)
    own->voxels[slice] = slice_of_window(storage, window, slice);
  for (int start = 1; start <= spread; start++)
    own->later[start] = storage == HL_STORAGE_U8 ? starting_u8(window->start, start)
                                                 : starting_u16(window->start, start);
}

/* Takes the taps (0..3, y, z) of every lane out of the lane's own slices, for z from 0 to 3. */
LANES_INLINE void own_taps(hl_storage storage, const own_slices *own, int spread, __m512i index, int y,
                           window_taps taps[4]) {
  window_slice rows[WINDOW_SIDE];
  if (storage == HL_STORAGE_U8) index = index_in_row_u8(index, y);
  for (int slice = 0; slice < spread + 4; slice++)
    rows[slice] = storage == HL_STORAGE_U8 ? own->voxels[slice] : rows_u16(&own->voxels[slice], y);
  for (int z = 0; z < 4; z++) {
    taps[z] = storage == HL_STORAGE_U8 ? taps_u8(&rows[z], index) : taps_u16(&rows[z], index);
    for (int start = 1; start <= spread; start++)
      if (storage == HL_STORAGE_U8) replace_taps_u8(&taps[z], own->later[start], &rows[z + start], index);
      else replace_taps_u16(&taps[z], own->later[start], &rows[z + start], index);
  }
}

LANES_INLINE lanes weigh_taps(hl_storage storage, const window_taps *taps, const row_weights *weights) {
  return storage == HL_STORAGE_U8 ? weigh_u8(taps, &weights->bytes) : weigh_u16(taps, &weights->shorts);
}
LANES_INLINE lanes slope_of_taps(hl_storage storage, const window_taps *taps, const row_slopes *slopes) {
  return storage == HL_STORAGE_U8 ? slope_u8(taps, &slopes->bytes) : slope_u16(taps, &slopes->shorts);
}

LANES_INLINE lanes sum_own_slices(hl_storage storage, const voxel_window *window, int spread,
                                  const lanes weight[3][4]) {
  own_slices own;
  window_taps taps[4];
  row_weights along = weights_of_row(storage, weight[0]);
  lanes plane[4] = {lanes_set(0), lanes_set(0), lanes_set(0), lanes_set(0)}, sum = lanes_set(0);
  load_own_slices(storage, window, spread, &own);
  for (int y = 0; y < 4; y++) {
    own_taps(storage, &own, spread, window->index, y, taps);
    for (int z = 0; z < 4; z++)
      plane[z] = lanes_fma(weigh_taps(storage, &taps[z], &along), weight[1][y], plane[z]);
  }
  for (int z = 0; z < 4; z++) sum = lanes_fma(plane[z], weight[2][z], sum);
  return from_units(storage, sum);
}

LANES_INLINE lanes sum_window(hl_storage storage, const voxel_window *window, const lanes weight[3][4]) {
  switch (window->slices - 4) {
    case 0: return sum_own_slices(storage, window, 0, weight);
    case 1: return sum_own_slices(storage, window, 1, weight);
    case 2: return sum_own_slices(storage, window, 2, weight);
    case 3: return sum_own_slices(storage, window, 3, weight);
    default: return sum_own_slices(storage, window, WINDOW_SPREAD, weight);
  }
}

static __attribute__((noinline)) lanes sum_window_u8(const voxel_window *window, const lanes weight[3][4]) {
  return sum_window(HL_STORAGE_U8, window, weight);
}
static __attribute__((noinline)) lanes sum_window_u16(const voxel_window *window, const lanes weight[3][4]) {
  return sum_window(HL_STORAGE_U16, window, weight);
}

/* ---- f32: slice by slice ---- */

/* Each lane's weight for a slice: the weight of the lane's tap in this slice; 0 if the lane has no tap in the
 * slice. */
LANES_INLINE lanes weight_of_slice(const voxel_window *window, int slice, const lanes weight[4]) {
  __m512 found = _mm512_setzero_ps();
  for (int tap = 0; tap < 4; tap++) {
    int start = slice - tap;
    if (start < 0 || start > WINDOW_SPREAD) continue;
    __mmask16 lanes_there = _mm512_cmpeq_epi32_mask(window->start, _mm512_set1_epi32(start));
    found = _mm512_mask_mov_ps(found, lanes_there, (__m512)weight[tap]);
  }
  return (lanes)found;
}

static __attribute__((noinline)) lanes sum_window_f32(const voxel_window *window, const lanes weight[3][4]) {
  lanes sum = lanes_set(0);
  for (int slice = 0; slice < window->slices; slice++) {
    window_slice voxels = slice_of_window(HL_STORAGE_F32, window, slice);
    lanes plane = lanes_set(0);
    for (int y = 0; y < 4; y++) {
      window_taps taps = taps_f32(&voxels, window->index, y);
      plane = lanes_fma(weigh_f32(&taps, weight[0]), weight[1][y], plane);
    }
    sum = lanes_fma(plane, weight_of_slice(window, slice, weight[2]), sum);
  }
  return sum;
}
LANES_INLINE lanes sum_of_window(hl_storage storage, const voxel_window *window, const lanes weight[3][4]) {
  return storage == HL_STORAGE_U8    ? sum_window_u8(window, weight)
         : storage == HL_STORAGE_U16 ? sum_window_u16(window, weight)
                                     : sum_window_f32(window, weight);
}

/* ---- gradients ---- */

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

/* Sums gradients over windows. Each window serves as many blocks of pixels as fit into the window. Returns
 * false if a single block does not fit a window. */
static __attribute__((unused)) int slopes_of_windows(const grid *grid, const lanes_int cell[3],
                                                     uint32_t active, uint32_t starts,
                                                     const tap_slope_weights *w, lanes3 *slope) {
  voxel_window window;
  if (!has_windows(grid)) return 0;
  for (uint32_t left = active; left != 0;) {
    uint32_t together = left;
    while (!open_window(grid, cell, together, &window))
      if ((together = drop_last_block(together, starts)) == 0) return 0;
    lanes3 some = grid->storage == HL_STORAGE_U8    ? slopes_of_window_u8(&window, w)
                  : grid->storage == HL_STORAGE_U16 ? slopes_of_window_u16(&window, w)
                                                    : slopes_of_window_f32(&window, w);
    if (together == active) {
      *slope = some;
      return 1;
    }
    join_slopes(together, some, slope);
    left &= ~together;
  }
  return 1;
}

#endif
