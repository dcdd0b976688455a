/* splat/window_lanes.h - the voxels around a block of pixels, u8, held in registers.
 *
 * Sixteen neighbouring pixels of a sheet draw on few voxels: most often on a window of 8x8 voxels and up to eight
 * slices. One slice of it fills a 512-bit register, one byte permutation takes four neighbouring taps of every lane from
 * it, and dot products of bytes weigh them. Lanes whose taps do not reach a slice weigh it by zero, which changes
 * no bit of their sums: these are the sums of gather_lanes.h and slope_lanes.h, in the same order. */
#ifndef HL_SPLAT_WINDOW_LANES_H
#define HL_SPLAT_WINDOW_LANES_H

#include "simd/lanes.h"
#include "splat/columns_lanes.h"

/* Weights along x as whole numbers, so that sums of u8 taps are exact whatever the instruction set. Of this unit, the
 * sum of four taps of 255 times derivatives' weights still fits 32 bits. */
static const float WHOLE_UNIT = 1 << 21, WHOLE_INVERSE = 1.0f / (1 << 21);

typedef struct whole_weights { lanes_int tap[4]; } whole_weights;

/* Rounded to the nearest whole number, |x| < 2^22: of a float from 2^23 to 2^24 a unit is the last bit, and adding
 * rounds to it. */
LANES_INLINE lanes_int round_to_whole(lanes x) {
  const float units = 3 << 22;
  return (lanes_int)(x + units) - (lanes_int)lanes_set(units);
}

/* Rounded; the third takes the error of the others, so that the sum is total units. */
LANES_INLINE whole_weights round_weights(const lanes weight[4], int total) {
  whole_weights whole;
  for (int i = 0; i < 4; i++)
    if (i != 2) whole.tap[i] = round_to_whole(weight[i] * WHOLE_UNIT);
  whole.tap[2] = total * (1 << 21) - (whole.tap[0] + whole.tap[1] + whole.tap[3]);
  return whole;
}

#if defined(__AVX512VBMI__) && defined(__AVX512VBMI2__) && defined(__AVX512VNNI__)
#define HL_BYTE_WINDOWS 1

enum { WINDOW_SIDE = GRID_COLUMN, WINDOW_SPREAD = WINDOW_SIDE - 4 }; /* voxels; how far lanes' first taps may lie apart */

typedef struct byte_window {
  const unsigned char *left, *right; /* the window's first row in the two columns that it lies in */
  size_t slice_bytes;
  __m512i shift;                 /* bits from the left column's first voxel to the window's, in every row */
  __m512i index;                 /* of each lane's taps in the first row of a slice, a byte each */
  __mmask16 starts[WINDOW_SPREAD + 1]; /* lanes whose taps start at this slice */
  int slices;
} byte_window;

/* The least cell of the active lanes along each axis. */
LANES_INLINE void lowest_of_lanes(const lanes_int cell[3], uint32_t active, int32_t low[3]) {
  for (int a = 0; a < 3; a++) low[a] = _mm512_mask_reduce_min_epi32((__mmask16)active, (__m512i)cell[a]);
}

/* The same of a whole block of pixels, in fewer steps: along a row or a column places rise or fall throughout, so that the
 * least is at a corner, rounding apart. */
LANES_INLINE void lowest_of_corners(const lanes_int cell[3], int32_t low[3]) {
  const __m512i of_two = _mm512_set_epi32(0, 0, 0, 0, 15, 12, 3, 0, 31, 28, 19, 16, 15, 12, 3, 0);
  __m512i corners = _mm512_permutex2var_epi32((__m512i)cell[0], of_two, (__m512i)cell[1]);
  corners = _mm512_mask_permutexvar_epi32(corners, 0x0f00, of_two, (__m512i)cell[2]);
  corners = _mm512_min_epi32(corners, _mm512_shuffle_epi32(corners, _MM_PERM_CDAB));
  corners = _mm512_min_epi32(corners, _mm512_shuffle_epi32(corners, _MM_PERM_BADC));
  low[0] = _mm_cvtsi128_si32(_mm512_castsi512_si128(corners));
  low[1] = _mm_cvtsi128_si32(_mm512_extracti32x4_epi32(corners, 1));
  low[2] = _mm_cvtsi128_si32(_mm512_extracti32x4_epi32(corners, 2));
}

/* cell: tap 0 is at cell - 1; all taps of active lanes lie in the grid. lowest: of cells, along each axis. False where they
 * do not fit a window. */
LANES_INLINE int open_window_at(const grid *grid, const lanes_int cell[3], const int32_t lowest[3], uint32_t active,
                                byte_window *window) {
  __mmask16 lanes_mask = (__mmask16)active, fits = (__mmask16)active;
  int32_t low[3];
  __m512i offset[3];
  if (grid->columns == NULL) return 0;
  for (int a = 0; a < 3; a++) {
    low[a] = lowest[a] - 1;
    if (a < 2 && low[a] > grid->dimension[a] - WINDOW_SIDE) low[a] = grid->dimension[a] - WINDOW_SIDE;
    offset[a] = _mm512_maskz_sub_epi32(lanes_mask, (__m512i)cell[a], _mm512_set1_epi32(low[a] + 1));
    fits = _mm512_mask_cmple_epu32_mask(fits, offset[a], _mm512_set1_epi32(WINDOW_SPREAD));
  }
  if (fits != lanes_mask) return 0;
  window->slices = 4;
  for (int slice = 0; slice <= WINDOW_SPREAD; slice++) {
    window->starts[slice] = _mm512_mask_cmpeq_epi32_mask(lanes_mask, offset[2], _mm512_set1_epi32(slice));
    if (window->starts[slice] != 0) window->slices = slice + 4;
  }
  __m512i first = _mm512_add_epi32(_mm512_slli_epi32(offset[1], 3), offset[0]);
  const __m512i lowest_byte = _mm512_set4_epi32(0x0c0c0c0c, 0x08080808, 0x04040404, 0);
  window->index = _mm512_add_epi8(_mm512_shuffle_epi8(first, lowest_byte), _mm512_set1_epi32(0x03020100));
  window->slice_bytes = grid->column_slice_bytes;
  window->left = grid->columns + (size_t)(low[0] / WINDOW_SIDE) * grid->column_bytes +
                 (size_t)low[2] * grid->column_slice_bytes + (size_t)low[1] * WINDOW_SIDE;
  window->right = window->left + (low[0] % WINDOW_SIDE != 0 ? grid->column_bytes : 0);
  window->shift = _mm512_set1_epi64(low[0] % WINDOW_SIDE * 8);
  return 1;
}

LANES_INLINE int open_window(const grid *grid, const lanes_int cell[3], uint32_t active, byte_window *window) {
  int32_t lowest[3];
  if (active == 0) return 0;
  lowest_of_lanes(cell, active, lowest);
  return open_window_at(grid, cell, lowest, active, window);
}

/* Of a block of neighbouring pixels, all of them active. */
LANES_INLINE int open_window_of_block(const grid *grid, const lanes_int cell[3], byte_window *window) {
  int32_t lowest[3];
  lowest_of_corners(cell, lowest);
  return open_window_at(grid, cell, lowest, 0xffff, window) || open_window(grid, cell, 0xffff, window);
}

LANES_INLINE __m512i window_slice(const byte_window *window, int slice) {
  size_t at = (size_t)slice * window->slice_bytes;
  return _mm512_shrdv_epi64(_mm512_loadu_si512(window->left + at), _mm512_loadu_si512(window->right + at), window->shift);
}

/* The four taps of every lane in row y of a slice. */
LANES_INLINE __m512i window_taps(const byte_window *window, __m512i slice, int y) {
  return _mm512_permutexvar_epi8(_mm512_add_epi8(window->index, _mm512_set1_epi8((char)(WINDOW_SIDE * y))), slice);
}

/* A lane's four weights as three signed bytes each, the highest first: whole = (d0 256 + d1) 256 + d2. */
typedef struct byte_weights { __m512i digit[3]; } byte_weights;

LANES_INLINE byte_weights split_weights(const whole_weights *whole) {
  __m512i biased[4];
  const __m512i bias = _mm512_set1_epi32(0x808080), sign = _mm512_set1_epi32((int)0x80808080);
  for (int tap = 0; tap < 4; tap++) biased[tap] = _mm512_add_epi32((__m512i)whole->tap[tap], bias);
  /* bytes of each lane: of two taps, the two lower digits in turn, or the highest; then of all four one digit each */
  const __m512i lane = _mm512_set_epi32(0x3c3c3c3c, 0x38383838, 0x34343434, 0x30303030, 0x2c2c2c2c, 0x28282828, 0x24242424,
                                        0x20202020, 0x1c1c1c1c, 0x18181818, 0x14141414, 0x10101010, 0x0c0c0c0c, 0x08080808,
                                        0x04040404, 0);
  const __m512i lower = _mm512_add_epi8(lane, _mm512_set1_epi32(0x41014000)), highest = _mm512_add_epi8(lane, _mm512_set1_epi32(0x42024202));
  const __m512i first = _mm512_add_epi8(lane, _mm512_set1_epi32(0x41400100)), second = _mm512_add_epi8(lane, _mm512_set1_epi32(0x43420302));
  __m512i low = _mm512_permutex2var_epi8(biased[0], lower, biased[1]), high = _mm512_permutex2var_epi8(biased[2], lower, biased[3]);
  __m512i low_top = _mm512_permutex2var_epi8(biased[0], highest, biased[1]);
  __m512i high_top = _mm512_permutex2var_epi8(biased[2], highest, biased[3]);
  byte_weights weights;
  weights.digit[2] = _mm512_xor_si512(_mm512_permutex2var_epi8(low, first, high), sign);
  weights.digit[1] = _mm512_xor_si512(_mm512_permutex2var_epi8(low, second, high), sign);
  weights.digit[0] = _mm512_xor_si512(_mm512_permutex2var_epi8(low_top, first, high_top), sign);
  return weights;
}

LANES_INLINE lanes weigh_taps(__m512i taps, const byte_weights *weights) {
  __m512i sum = _mm512_dpbusd_epi32(_mm512_setzero_si512(), taps, weights->digit[0]);
  sum = _mm512_dpbusd_epi32(_mm512_slli_epi32(sum, 8), taps, weights->digit[1]);
  sum = _mm512_dpbusd_epi32(_mm512_slli_epi32(sum, 8), taps, weights->digit[2]);
  return lanes_from_int((lanes_int)sum);
}

/* Every lane's weight of a slice: that of the tap that lies in it, or zero. */
LANES_INLINE lanes weight_of_slice(const byte_window *window, int slice, const lanes weight[4]) {
  __m512 found = _mm512_setzero_ps();
  for (int tap = 0; tap < 4; tap++) {
    int start = slice - tap;
    if (start >= 0 && start <= WINDOW_SPREAD) found = _mm512_mask_mov_ps(found, window->starts[start], (__m512)weight[tap]);
  }
  return (lanes)found;
}

static __attribute__((noinline)) lanes sum_window(const byte_window *window, const lanes weight[3][4]) {
  whole_weights whole = round_weights(weight[0], 1);
  byte_weights along = split_weights(&whole);
  lanes sum = lanes_set(0);
  for (int slice = 0; slice < window->slices; slice++) {
    __m512i voxels = window_slice(window, slice);
    lanes plane = lanes_set(0);
    for (int y = 0; y < 4; y++) plane = plane + weigh_taps(window_taps(window, voxels, y), &along) * weight[1][y];
    sum = sum + plane * weight_of_slice(window, slice, weight[2]);
  }
  return sum * WHOLE_INVERSE;
}
#endif

#endif
