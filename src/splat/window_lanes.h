/* splat/window_lanes.h - the voxels around a block of pixels, u8, held in registers.
 *
 * Sixteen neighbouring pixels of a sheet draw on few voxels: most often on a window of 8x8 voxels and up to eight
 * slices. One slice of it fills a 512-bit register, from which permutations take four neighbouring taps of every lane, and
 * dot products of whole numbers weigh them: of bytes (window_bytes_lanes.h) or, where the processor has no permutations of
 * bytes, of words (window_words_lanes.h). Lanes whose taps do not reach a slice weigh it by zero, which changes
 * no bit of their sums: these are the sums of gather_lanes.h and slope_lanes.h, in the same order. */
#ifndef HL_SPLAT_WINDOW_LANES_H
#define HL_SPLAT_WINDOW_LANES_H

#include "splat/columns_lanes.h"

#if defined(__AVX512VBMI__) && defined(__AVX512VBMI2__) && defined(__AVX512VNNI__)
#define HL_BYTE_WINDOWS 1
#include "splat/window_bytes_lanes.h"
#elif defined(__AVX512BW__)
#define HL_BYTE_WINDOWS 1
#include "splat/window_words_lanes.h"
#endif

#ifdef HL_BYTE_WINDOWS
enum { WINDOW_SIDE = GRID_COLUMN, WINDOW_SPREAD = WINDOW_SIDE - 4 }; /* voxels; how far lanes' first taps may lie apart */

typedef struct byte_window {
  const unsigned char *left, *right; /* the window's first row in the two columns that it lies in */
  size_t slice_bytes;
  __m512i shift;                 /* bits from the left column's first voxel to the window's, in every row */
  window_index index;            /* of each lane's taps */
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
  const int32_t side[3] = {WINDOW_WIDTH, WINDOW_SIDE, WINDOW_SIDE};
  int32_t low[3];
  __m512i offset[3];
  if (grid->columns == NULL) return 0;
  for (int a = 0; a < 3; a++) {
    low[a] = lowest[a] - 1;
    if (a < 2 && low[a] > grid->dimension[a] - side[a]) low[a] = grid->dimension[a] - side[a];
    offset[a] = _mm512_maskz_sub_epi32(lanes_mask, (__m512i)cell[a], _mm512_set1_epi32(low[a] + 1));
    fits = _mm512_mask_cmple_epu32_mask(fits, offset[a], _mm512_set1_epi32(side[a] - 4));
  }
  if (fits != lanes_mask) return 0;
  window->slices = 4;
  for (int slice = 0; slice <= WINDOW_SPREAD; slice++) {
    window->starts[slice] = _mm512_mask_cmpeq_epi32_mask(lanes_mask, offset[2], _mm512_set1_epi32(slice));
    if (window->starts[slice] != 0) window->slices = slice + 4;
  }
  window->index = window_index_at(offset[0], offset[1]);
  window->slice_bytes = grid->column_slice_bytes;
  window->left = grid->columns + (size_t)(low[0] / WINDOW_SIDE) * grid->column_bytes +
                 (size_t)low[2] * grid->column_slice_bytes + (size_t)low[1] * WINDOW_SIDE;
  window->right = window->left + (low[0] % WINDOW_SIDE > WINDOW_SIDE - WINDOW_WIDTH ? grid->column_bytes : 0);
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

LANES_INLINE window_slice slice_of_window(const byte_window *window, int slice) {
  size_t at = (size_t)slice * window->slice_bytes;
  return join_columns(_mm512_loadu_si512(window->left + at), _mm512_loadu_si512(window->right + at), window->shift);
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
  split_weights along = split_whole(&whole);
  lanes sum = lanes_set(0);
  for (int slice = 0; slice < window->slices; slice++) {
    window_slice voxels = slice_of_window(window, slice);
    lanes plane = lanes_set(0);
    for (int y = 0; y < 4; y++) plane = plane + weigh_taps(taps_in_row(&voxels, &window->index, y), &along) * weight[1][y];
    sum = sum + plane * weight_of_slice(window, slice, weight[2]);
  }
  return sum * WHOLE_INVERSE;
}
#endif

#endif
