/* fill/windows_avx2_lanes.h - sums over windows of u8 voxels with AVX2 (windows_lanes.h).
 *
 * A slice of a window has 8x8 voxels from the grid's columns. The code makes three or five copies of a slice,
 * each four voxels wide. Each copy begins one voxel further along x than the copy before. So four rows of
 * four taps are sixteen consecutive bytes of a copy, which one load takes. Two lanes' taps share a register
 * (rows_avx2_lanes.h). */
#ifndef HL_FILL_WINDOWS_AVX2_LANES_H
#define HL_FILL_WINDOWS_AVX2_LANES_H

#include "fill/block_lanes.h"
#include "fill/rows_avx2_lanes.h"
#include "simd/narrow.h"

enum {
  WINDOW_SIDE = GRID_COLUMN,       /* width of a window, in voxels */
  WINDOW_SPREAD = WINDOW_SIDE - 4, /* the greatest distance, in voxels, between the first taps of two lanes of
                                    * a window */
  USUAL_SPREAD = 2,                /* the greatest distance, in most blocks, between the first taps of two
                                    * lanes; because the number is a constant, the compiler unrolls loops */
  USUAL_SLICES = 4 + USUAL_SPREAD
};
enum { COPY_BYTES = 4 * WINDOW_SIDE, SLICE_BYTES = (WINDOW_SPREAD + 1) * COPY_BYTES };

typedef struct voxel_window {
  const unsigned char *first; /* the address of the window's first row, in its column */
  size_t slice_bytes;
  size_t beside;      /* number of bytes from the column to the next column; 0 if the window lies within one
                       * column */
  int shift;          /* bits from the column's first voxel to the window's first voxel, in every row */
  int slices, copies; /* slices: number of slices; copies: number of copies of each slice, which is one more
                       * than the greatest distance along x between the first taps of lanes */
  __m256i taps;       /* for each lane, the number of bytes to its first tap in the copies, in the order of
                       * lanes in simd/narrow.h */
} voxel_window;

typedef struct window_copies {
  _Alignas(32) unsigned char slice[WINDOW_SIDE][SLICE_BYTES];
} window_copies;

/* Returns whether windows of voxels can be opened in a grid. */
LANES_INLINE int has_windows(const grid *grid) {
  return grid->columns != NULL && grid->dimension[2] >= USUAL_SLICES;
}

/* Opens a window of voxels in a grid that has windows. cell: tap 0 is at cell - 1; all taps of active lanes
 * lie in the grid. lowest: the least of the active lanes' cells along each axis. Returns false if the taps do
 * not fit a window. */
LANES_INLINE int open_window_at(const grid *grid, const lanes_int cell[3], const int32_t lowest[3],
                                uint32_t active, voxel_window *window) {
  const int32_t side[3] = {WINDOW_SIDE, WINDOW_SIDE, USUAL_SLICES};
  int32_t low[3];
  __m256i offset[3];
  for (int a = 0; a < 3; a++) {
    low[a] = lowest[a] - 1;
    if (low[a] > grid->dimension[a] - side[a]) low[a] = grid->dimension[a] - side[a];
    offset[a] = narrow_shorts(cell[a] - (low[a] + 1));
    if (active != 0xffff) offset[a] = _mm256_and_si256(offset[a], narrow_shorts(lanes_from_bits(active)));
  }
  if (any_short_above(_mm256_max_epu16(_mm256_max_epu16(offset[0], offset[1]), offset[2]), WINDOW_SPREAD))
    return 0;
  window->slices = any_short_above(offset[2], USUAL_SPREAD) ? WINDOW_SIDE : USUAL_SLICES;
  if (window->slices > grid->dimension[2] - low[2]) window->slices = grid->dimension[2] - low[2];
  window->copies = any_short_above(offset[0], USUAL_SPREAD) ? WINDOW_SPREAD + 1 : USUAL_SPREAD + 1;
  __m256i slice = _mm256_mullo_epi16(offset[2], _mm256_set1_epi16(SLICE_BYTES));
  __m256i copy = _mm256_mullo_epi16(offset[0], _mm256_set1_epi16(COPY_BYTES));
  window->taps = _mm256_add_epi16(_mm256_add_epi16(slice, copy),
                                  _mm256_slli_epi16(offset[1], 2)); /* a row of a copy has four bytes */
  uint32_t first_voxel = (uint32_t)low[0], within = first_voxel % GRID_COLUMN;
  window->slice_bytes = grid->column_slice_bytes;
  window->first = grid->columns + (size_t)(first_voxel / GRID_COLUMN) * grid->column_bytes +
                  (size_t)low[2] * grid->column_slice_bytes + (size_t)low[1] * GRID_COLUMN;
  window->beside = within > 0 ? grid->column_bytes : 0;
  window->shift = (int)within * 8;
  return 1;
}

LANES_INLINE int open_window(const grid *grid, const lanes_int cell[3], uint32_t active,
                             voxel_window *window) {
  if (active == 0) return 0;
  lanes_int used[4] = {cell[0], cell[1], cell[2]};
  int32_t lowest[4];
  int first_lane = __builtin_ctz(active);
  if (active != 0xffff)
    for (int a = 0; a < 3; a++)
      used[a] = lanes_select_int(lanes_from_bits(active), cell[a], lanes_set_int(cell[a][first_lane]));
  used[3] = used[2];
  _mm_storeu_si128((__m128i *)(void *)lowest, lanes_least_of_each(used));
  return open_window_at(grid, cell, lowest, active, window);
}

/* Loads two neighbouring rows of eight voxels, and the two rows that lie four rows below them. */
LANES_INLINE __m256i rows_apart(const unsigned char *first) {
  __m256i rows = _mm256_castsi128_si256(_mm_loadu_si128((const __m128i *)(const void *)first));
  return _mm256_inserti128_si256(
      rows, _mm_loadu_si128((const __m128i *)(const void *)(first + 4 * GRID_COLUMN)), 1);
}

/* Stores the lower or the upper half of each row in a copy, in the order of the rows. */
LANES_INLINE void store_copy(unsigned char *copy, const __m256i rows[2], int upper) {
  __m256 a = _mm256_castsi256_ps(rows[0]), b = _mm256_castsi256_ps(rows[1]);
  _mm256_store_ps((float *)(void *)copy,
                  upper ? _mm256_shuffle_ps(a, b, 0xdd) : _mm256_shuffle_ps(a, b, 0x88));
}

LANES_INLINE void copy_slice_of(const voxel_window *window, int slice, int count, window_copies *copies) {
  const unsigned char *first = window->first + (size_t)slice * window->slice_bytes,
                      *beside = first + window->beside;
  __m128i left = _mm_cvtsi32_si128(window->shift), right = _mm_cvtsi32_si128(64 - window->shift);
  unsigned char *copy = copies->slice[slice];
  __m256i rows[2];
  for (int i = 0; i < 2; i++) {
    rows[i] = _mm256_or_si256(_mm256_srl_epi64(rows_apart(first + 2 * i * GRID_COLUMN), left),
                              _mm256_sll_epi64(rows_apart(beside + 2 * i * GRID_COLUMN), right));
    /* adds 128, because 128 was subtracted from the voxels in the columns */
    rows[i] = _mm256_xor_si256(rows[i], _mm256_set1_epi8((char)0x80));
  }
  if (count > 4) store_copy(copy + 4 * COPY_BYTES, rows, 1);
  for (int x = 0; x < count && x < 4; x++) {
    store_copy(copy + x * COPY_BYTES, rows, 0);
    for (int i = 0; i < 2; i++) rows[i] = _mm256_srli_epi64(rows[i], 8);
  }
}

LANES_INLINE void copy_slices(const voxel_window *window, int count, window_copies *copies) {
  for (int slice = 0; slice < USUAL_SLICES; slice++) copy_slice_of(window, slice, count, copies);
#pragma GCC unroll 1
  for (int slice = USUAL_SLICES; slice < window->slices; slice++) copy_slice_of(window, slice, count, copies);
}

LANES_INLINE void copy_window(const voxel_window *window, window_copies *copies) {
  if (window->copies == USUAL_SPREAD + 1) copy_slices(window, USUAL_SPREAD + 1, copies);
  else copy_slices(window, WINDOW_SPREAD + 1, copies);
}

/* Repeats lane k of eight in the lower half of the register, and lane k + 4 in the upper half. */
LANES_INLINE __m256i lanes_of_two(const lanes_int *x, int half, int k) {
  __m256i eight = _mm256_loadu_si256((const __m256i *)(const void *)x + half);
  return _mm256_shuffle_epi8(eight, _mm256_set1_epi32(0x03020100 + k * 0x04040404));
}

/* The weights along x, or slopes, of two lanes, paired as in byte_weights. Each lane's weights fill half a
 * register, repeated for each row. */
typedef struct weights_of_two {
  __m256i pair[2];
} weights_of_two;

LANES_INLINE weights_of_two weights_of_pair(const byte_weights *weights, int half, int k) {
  return (weights_of_two){
      {lanes_of_two(&weights->pair[0], half, k), lanes_of_two(&weights->pair[1], half, k)}};
}

/* The addresses of the taps of two lanes, lane k and lane k + 4 of eight, in the copies of windows. */
LANES_INLINE pair_of_taps copied_taps_of_pair(const window_copies *copies, const narrow_offsets *taps,
                                              int half, int k) {
  const uint16_t *at = narrow_pair(taps, half, k);
  return (pair_of_taps){&copies->slice[0][0] + at[0], &copies->slice[0][0] + at[NARROW_SECOND]};
}

/* One slice of two lanes' taps: four rows of four taps each, as 16-bit numbers. The taps are paired like the
 * weights in byte_weights. */
typedef struct taps_of_two {
  __m256i pair[2];
} taps_of_two;

LANES_INLINE taps_of_two slice_of_two(const pair_of_taps *taps, int z) {
  __m128i first = _mm_loadu_si128((const __m128i *)(const void *)(taps->first + z * SLICE_BYTES));
  __m128i second = _mm_loadu_si128((const __m128i *)(const void *)(taps->second + z * SLICE_BYTES));
  __m256i bytes = _mm256_inserti128_si256(_mm256_castsi128_si256(first), second, 1);
  return (taps_of_two){{_mm256_and_si256(bytes, _mm256_set1_epi16(255)), _mm256_srli_epi16(bytes, 8)}};
}

/* The weighted sum of each row of two lanes' taps. */
LANES_INLINE __m256i weigh_two(const taps_of_two *taps, const weights_of_two *weights) {
  return _mm256_add_epi32(_mm256_madd_epi16(taps->pair[0], weights->pair[0]),
                          _mm256_madd_epi16(taps->pair[1], weights->pair[1]));
}

static __attribute__((noinline)) lanes sum_window_u8(const voxel_window *window, const lanes weight[3][4]) {
  window_copies copies;
  narrow_offsets offsets;
  __m256 sums[2];
  row_weights weights = weights_of_row(HL_STORAGE_U8, weight[0]);
  copy_window(window, &copies);
  narrow_store(&offsets, window->taps);
#pragma GCC unroll 1
  for (int half = 0; half < 2; half++) {
    sums_of_rows rows;
    for (int k = 0; k < 4; k++) {
      pair_of_taps taps = copied_taps_of_pair(&copies, &offsets, half, k);
      weights_of_two along = weights_of_pair(&weights.bytes, half, k);
      for (int z = 0; z < 4; z++) {
        taps_of_two of_slice = slice_of_two(&taps, z);
        rows.of_two[z][k] = weigh_two(&of_slice, &along);
      }
    }
    sums[half] = add_slices(&rows, weight, half);
  }
  lanes sum;
  memcpy(&sum, sums, sizeof sum);
  return sum;
}

LANES_INLINE lanes sum_of_window(hl_storage storage, const voxel_window *window, const lanes weight[3][4]) {
  (void)storage; /* the storage is always u8, because other voxels have no windows */
  return sum_window_u8(window, weight);
}

/* ---- gradients ---- */

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
               "signed 16-bit numbers hold offsets in the copies of sixteen windows");

/* Sums gradients over windows. Each window serves as many blocks of pixels as fit into the window. Afterwards
 * one sum takes taps from the copies of all windows. Returns false if a single block does not fit a window.
 */
static __attribute__((unused)) int slopes_of_windows(const grid *grid, const lanes_int cell[3],
                                                     uint32_t active, uint32_t starts,
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
