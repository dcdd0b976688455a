/* splat/window_lanes.h - the voxels around a block of pixels, held in registers; where there is AVX2 alone,
 * close by in memory (window_copies_lanes.h).
 *
 * Sixteen neighbouring pixels of a sheet draw on few voxels: most often on a window of 8x8 voxels and up to
 * eight slices. One slice of it fills one to four 512-bit registers, from which permutations take four
 * neighbouring taps of every lane. u8 voxels come from the grid's columns, permuted as bytes
 * (window_bytes_lanes.h) or, where the processor cannot, as words (window_words_lanes.h); others come from
 * the volume's rows (window_rows_lanes.h). Lanes whose taps do not reach a slice weigh it by zero, which
 * changes no bit of their sums: these are the sums of gather_lanes.h and slope_lanes.h, in the same order. */
#ifndef HL_SPLAT_WINDOW_LANES_H
#define HL_SPLAT_WINDOW_LANES_H

#if defined(__AVX512BW__)
#define HL_WINDOWS 1

#include "splat/columns_lanes.h"
#include "splat/row_lanes.h"

#if defined(HL_PERMUTES_BYTES)
#include "splat/window_bytes_lanes.h"
#else
#include "splat/window_words_lanes.h"
#endif
#include "splat/window_rows_lanes.h"

enum {
  WINDOW_SIDE = GRID_COLUMN,
  WINDOW_SPREAD = WINDOW_SIDE - 4
}; /* voxels; how far lanes' first taps may lie apart */

typedef struct voxel_window {
  const unsigned char *first; /* the window's first row: of u8 voxels, in their column */
  size_t row_bytes, slice_bytes;
  size_t beside; /* u8: bytes to the next column, where the window reaches into it */
  __m512i shift; /* u8: bits from the column's first voxel to the window's, in every row */
  __m512i index; /* of each lane's taps in the first row */
  __m512i start; /* of each lane's taps: the slice in which they begin; 0 of idle lanes */
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

/* Where the window's first voxel lies. */
LANES_INLINE void place_window(const grid *grid, const int32_t low[3], voxel_window *window) {
  if (grid->storage == HL_STORAGE_U8) {
    int32_t within = low[0] % GRID_COLUMN;
    window->slice_bytes = grid->column_slice_bytes;
    window->first = grid->columns + (size_t)(low[0] / GRID_COLUMN) * grid->column_bytes +
                    (size_t)low[2] * grid->column_slice_bytes + (size_t)low[1] * GRID_COLUMN;
    window->beside = within > GRID_COLUMN - WINDOW_WIDTH ? grid->column_bytes : 0;
    window->shift = _mm512_set1_epi64(within * 8);
  } else {
    size_t voxel = hl_storage_bytes(grid->storage);
    window->row_bytes = (size_t)grid->dimension[0] * voxel;
    window->slice_bytes = (size_t)grid->dimension[1] * window->row_bytes;
    window->first = (const unsigned char *)grid->voxels + (size_t)low[2] * window->slice_bytes +
                    (size_t)low[1] * window->row_bytes + (size_t)low[0] * voxel;
  }
}

/* Whether a grid has windows at all. */
LANES_INLINE int has_windows(const grid *grid) {
  if (grid->storage == HL_STORAGE_U8) return grid->columns != NULL;
  return grid->dimension[0] >= WINDOW_SIDE && grid->dimension[1] >= WINDOW_SIDE;
}

/* Of a grid that has windows. cell: tap 0 is at cell - 1; all taps of active lanes lie in the grid. lowest:
 * of cells, along each axis. False where they do not fit a window. */
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
  place_window(grid, low, window);
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

/* ---- u8 and u16: every lane's own four slices ---- */

/* Of u8 and u16 voxels taps of tap row y and slice z are taken for all lanes at once: from the slice in which
 * the first lanes' begin, and from later ones, spread of them, for lanes that begin later. That is fewer sums
 * than one for each slice. */
typedef struct own_slices {
  window_slice voxels[WINDOW_SIDE];
  window_lanes later[WINDOW_SPREAD + 1]; /* lanes whose taps start at this slice */
} own_slices;

LANES_INLINE void load_own_slices(hl_storage storage, const voxel_window *window, int spread,
                                  own_slices *own) {
  for (int slice = 0; slice < spread + 4; slice++)
    own->voxels[slice] = slice_of_window(storage, window, slice);
  for (int start = 1; start <= spread; start++)
    own->later[start] = storage == HL_STORAGE_U8 ? starting_u8(window->start, start)
                                                 : starting_u16(window->start, start);
}

/* The taps (0..3, y, z) of every lane, z from 0 to 3. */
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

/* Every lane's weight of a slice: that of the tap that lies in it, or zero. */
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
#elif defined(__AVX2__)
#define HL_WINDOWS    1
#define HL_SHORT_ROWS 1

#include "splat/short_rows_lanes.h"
#include "splat/window_copies_lanes.h"
#endif

#ifdef HL_WINDOWS
/* The sums of a block's active lanes, through one window or one for each half of it. lowest: where every lane
 * is active, the least cell along each axis, rounding apart; else null. False where its taps lie too far
 * apart. */
LANES_INLINE int sum_of_windows(const grid *grid, const lanes_int cell[3], const int32_t *lowest,
                                uint32_t active, const lanes weight[3][4], lanes *sum) {
  hl_storage storage = grid->storage;
  voxel_window window, below;
  const uint32_t upper = 0x00ff; /* half of a block */
  if (!has_windows(grid)) return 0;
  if ((lowest != NULL && open_window_at(grid, cell, lowest, active, &window)) ||
      open_window(grid, cell, active, &window)) {
    *sum = sum_of_window(storage, &window, weight);
    return 1;
  }
  if (!open_window(grid, cell, active & upper, &window) || !open_window(grid, cell, active & ~upper, &below))
    return 0;
  *sum = lanes_select(lanes_from_bits(upper), sum_of_window(storage, &window, weight),
                      sum_of_window(storage, &below, weight));
  return 1;
}
#endif

#endif
