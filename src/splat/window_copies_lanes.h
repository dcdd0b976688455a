/* splat/window_copies_lanes.h - the voxels around a block of pixels where there are no registers of 512 bits: u8 ones, in memory.
 *
 * A slice of a window, 8x8 voxels of the grid's columns, is written down three times, or five, each time a voxel further along x and
 * four voxels wide: four rows of four taps of a lane are then sixteen bytes in a row, one load. Two lanes' taps share a register, those
 * of lanes k and k + 4, and are weighed there; what comes out, a row of taps in each number, is turned so that lanes lie side by side. */
#ifndef HL_SPLAT_WINDOW_COPIES_LANES_H
#define HL_SPLAT_WINDOW_COPIES_LANES_H

#include "splat/columns_lanes.h"
#include "splat/row_lanes.h"

enum { WINDOW_SIDE = GRID_COLUMN, WINDOW_SPREAD = WINDOW_SIDE - 4 }; /* voxels; how far lanes' first taps may lie apart */
enum { USUAL_SPREAD = 2, USUAL_SLICES = 4 + USUAL_SPREAD }; /* few blocks need more, and how many no processor foresees */
enum { COPY_BYTES = 4 * WINDOW_SIDE, SLICE_BYTES = (WINDOW_SPREAD + 1) * COPY_BYTES };

typedef struct voxel_window {
  const unsigned char *first;    /* the window's first row, in its column */
  size_t slice_bytes;
  size_t beside;                 /* bytes to the next column, where the window reaches into it */
  int shift;                     /* bits from the column's first voxel to the window's, in every row */
  int slices, copies;            /* of each slice: as far as lanes' first taps lie apart, and one */
  lanes_int taps;                /* bytes to each lane's first in the copies */
} voxel_window;

typedef struct window_copies { _Alignas(32) unsigned char slice[WINDOW_SIDE][SLICE_BYTES]; } window_copies;

/* cell: tap 0 is at cell - 1; all taps of active lanes lie in the grid. False where they do not fit a window. */
LANES_INLINE int open_window(const grid *grid, const lanes_int cell[3], uint32_t active, voxel_window *window) {
  if (grid->columns == NULL || grid->dimension[2] < USUAL_SLICES || active == 0) return 0;
  const int32_t scale[3] = {COPY_BYTES, 4, SLICE_BYTES}, side[3] = {WINDOW_SIDE, WINDOW_SIDE, USUAL_SLICES};
  lanes_int used[4] = {cell[0], cell[1], cell[2]}, far[3], beyond = lanes_set_int(0), taps = lanes_set_int(0);
  int first_lane = __builtin_ctz(active);
  if (active != 0xffff)
    for (int a = 0; a < 3; a++) used[a] = lanes_select_int(lanes_from_bits(active), cell[a], lanes_set_int(cell[a][first_lane]));
  int32_t low[4];
  used[3] = used[2];
  _mm_storeu_si128((__m128i *)(void *)low, lanes_least_of_each(used));
  for (int a = 0; a < 3; a++) {
    low[a]--;
    if (low[a] > grid->dimension[a] - side[a]) low[a] = grid->dimension[a] - side[a];
    lanes_int offset = used[a] - (low[a] + 1);
    beyond |= offset + (WINDOW_SIDE - 1 - WINDOW_SPREAD);
    far[a] = offset > USUAL_SPREAD;
    taps += offset * scale[a];
  }
  if (lanes_bits((beyond & -WINDOW_SIDE) != 0) != 0) return 0;
  window->slices = lanes_bits(far[2]) == 0 ? USUAL_SLICES : WINDOW_SIDE;
  if (window->slices > grid->dimension[2] - low[2]) window->slices = grid->dimension[2] - low[2];
  window->copies = lanes_bits(far[0]) == 0 ? USUAL_SPREAD + 1 : WINDOW_SPREAD + 1;
  window->taps = taps;
  uint32_t first_voxel = (uint32_t)low[0], within = first_voxel % GRID_COLUMN;
  window->slice_bytes = grid->column_slice_bytes;
  window->first = grid->columns + (size_t)(first_voxel / GRID_COLUMN) * grid->column_bytes + (size_t)low[2] * grid->column_slice_bytes +
                  (size_t)low[1] * GRID_COLUMN;
  window->beside = within > 0 ? grid->column_bytes : 0;
  window->shift = (int)within * 8;
  return 1;
}

LANES_INLINE int open_window_of_block(const grid *grid, const lanes_int cell[3], voxel_window *window) {
  return open_window(grid, cell, 0xffff, window);
}

/* Two rows of eight voxels, and the two four rows below. */
LANES_INLINE __m256i rows_apart(const unsigned char *first) {
  __m256i rows = _mm256_castsi128_si256(_mm_loadu_si128((const __m128i *)(const void *)first));
  return _mm256_inserti128_si256(rows, _mm_loadu_si128((const __m128i *)(const void *)(first + 4 * GRID_COLUMN)), 1);
}

/* The lower or upper half of each row, rows in their order. */
LANES_INLINE void store_copy(unsigned char *copy, const __m256i rows[2], int upper) {
  __m256 a = _mm256_castsi256_ps(rows[0]), b = _mm256_castsi256_ps(rows[1]);
  _mm256_store_ps((float *)(void *)copy, upper ? _mm256_shuffle_ps(a, b, 0xdd) : _mm256_shuffle_ps(a, b, 0x88));
}

LANES_INLINE void copy_slice_of(const voxel_window *window, int slice, int count, window_copies *copies) {
  const unsigned char *first = window->first + (size_t)slice * window->slice_bytes, *beside = first + window->beside;
  __m128i left = _mm_cvtsi32_si128(window->shift), right = _mm_cvtsi32_si128(64 - window->shift);
  unsigned char *copy = copies->slice[slice];
  __m256i rows[2];
  for (int i = 0; i < 2; i++) {
    rows[i] = _mm256_or_si256(_mm256_srl_epi64(rows_apart(first + 2 * i * GRID_COLUMN), left),
                              _mm256_sll_epi64(rows_apart(beside + 2 * i * GRID_COLUMN), right));
    rows[i] = _mm256_xor_si256(rows[i], _mm256_set1_epi8((char)0x80)); /* in columns voxels are less 128 */
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

/* Of each half of eight lanes number k, in all of that half. */
LANES_INLINE __m256i lanes_of_two(const lanes_int *x, int half, int k) {
  __m256i eight = _mm256_loadu_si256((const __m256i *)(const void *)x + half);
  return _mm256_shuffle_epi8(eight, _mm256_set1_epi32(0x03020100 + k * 0x04040404));
}

/* Two lanes' weights along x, each lane's in half a register, once for each row, as byte_weights has them; and their slopes. */
typedef struct weights_of_two { __m256i pair[2], bias; } weights_of_two;
typedef struct slopes_of_two { __m256i pair[2]; } slopes_of_two;

LANES_INLINE weights_of_two weights_of_pair(const byte_weights *weights, int half, int k) {
  return (weights_of_two){{lanes_of_two(&weights->pair[0], half, k), lanes_of_two(&weights->pair[1], half, k)},
                          lanes_of_two(&weights->bias, half, k)};
}
LANES_INLINE slopes_of_two slopes_of_pair(const byte_slopes *slopes, int half, int k) {
  return (slopes_of_two){{lanes_of_two(&slopes->pair[0], half, k), lanes_of_two(&slopes->pair[1], half, k)}};
}

/* The taps of lanes k and k + 4 of a half. */
typedef struct pair_of_taps { const unsigned char *first, *second; } pair_of_taps;

LANES_INLINE pair_of_taps taps_of_pair(const void *copies, const lanes_offsets *taps, int half, int k) {
  const int32_t *at = taps->at + 8 * half + k;
  return (pair_of_taps){(const unsigned char *)copies + at[0], (const unsigned char *)copies + at[4]};
}

/* Slice z of them: four rows of four each, and in 16 bits those that share a pair. */
typedef struct taps_of_two { __m256i bytes, pair[2]; } taps_of_two;

LANES_INLINE taps_of_two slice_of_two(const pair_of_taps *taps, int z) {
  __m128i first = _mm_loadu_si128((const __m128i *)(const void *)(taps->first + z * SLICE_BYTES));
  __m128i second = _mm_loadu_si128((const __m128i *)(const void *)(taps->second + z * SLICE_BYTES));
  __m256i bytes = _mm256_inserti128_si256(_mm256_castsi128_si256(first), second, 1);
  return (taps_of_two){bytes, {_mm256_and_si256(bytes, _mm256_set1_epi16(255)), _mm256_srli_epi16(bytes, 8)}};
}

/* Each row's sum. */
LANES_INLINE __m256i multiply_two(const taps_of_two *taps, const __m256i pair[2]) {
  return _mm256_add_epi32(_mm256_madd_epi16(taps->pair[0], pair[0]), _mm256_madd_epi16(taps->pair[1], pair[1]));
}
LANES_INLINE __m256i weigh_two(const taps_of_two *taps, const weights_of_two *weights) {
  __m256i biased = _mm256_madd_epi16(_mm256_maddubs_epi16(taps->bytes, weights->bias), _mm256_set1_epi16(BIAS_UNITS));
  return _mm256_add_epi32(multiply_two(taps, weights->pair), biased);
}

/* From four rows of two lanes in each of four, to eight lanes in each row, as floats. */
LANES_INLINE void turn_rows(const __m256i of_two[4], __m256 row[4]) {
  __m256i a = _mm256_unpacklo_epi32(of_two[0], of_two[1]), b = _mm256_unpacklo_epi32(of_two[2], of_two[3]);
  __m256i c = _mm256_unpackhi_epi32(of_two[0], of_two[1]), d = _mm256_unpackhi_epi32(of_two[2], of_two[3]);
  row[0] = _mm256_cvtepi32_ps(_mm256_unpacklo_epi64(a, b));
  row[1] = _mm256_cvtepi32_ps(_mm256_unpackhi_epi64(a, b));
  row[2] = _mm256_cvtepi32_ps(_mm256_unpacklo_epi64(c, d));
  row[3] = _mm256_cvtepi32_ps(_mm256_unpackhi_epi64(c, d));
}

/* Eight of sixteen lanes. */
LANES_INLINE __m256 half_of(const lanes *x, int half) { return _mm256_loadu_ps((const float *)x + 8 * half); }

/* Rows weighed along y and added to nothing, in their order. */
LANES_INLINE __m256 add_rows(const __m256 row[4], const lanes weight[4], int half) {
  __m256 plane = _mm256_setzero_ps();
  for (int y = 0; y < 4; y++) plane = _mm256_fmadd_ps(row[y], half_of(&weight[y], half), plane);
  return plane;
}

static __attribute__((noinline)) lanes sum_window_u8(const voxel_window *window, const lanes weight[3][4]) {
  window_copies copies;
  lanes_offsets offsets;
  __m256 sums[2];
  row_weights weights = weights_of_row(HL_STORAGE_U8, weight[0]);
  copy_window(window, &copies);
  lanes_store_offsets(&offsets, window->taps);
#pragma GCC unroll 1
  for (int half = 0; half < 2; half++) {
    __m256i of_two[4][4];
    __m256 sum = _mm256_setzero_ps();
    for (int k = 0; k < 4; k++) {
      pair_of_taps taps = taps_of_pair(&copies, &offsets, half, k);
      weights_of_two along = weights_of_pair(&weights.bytes, half, k);
      for (int z = 0; z < 4; z++) {
        taps_of_two of_slice = slice_of_two(&taps, z);
        of_two[z][k] = weigh_two(&of_slice, &along);
      }
    }
    for (int z = 0; z < 4; z++) {
      __m256 row[4];
      turn_rows(of_two[z], row);
      sum = _mm256_fmadd_ps(add_rows(row, weight[1], half), half_of(&weight[2][z], half), sum);
    }
    sums[half] = _mm256_mul_ps(sum, _mm256_set1_ps(WEIGHT_INVERSE));
  }
  lanes sum;
  memcpy(&sum, sums, sizeof sum);
  return sum;
}

LANES_INLINE lanes sum_of_window(hl_storage storage, const voxel_window *window, const lanes weight[3][4]) {
  (void)storage; /* there are windows of u8 voxels only */
  return sum_window_u8(window, weight);
}

#endif
