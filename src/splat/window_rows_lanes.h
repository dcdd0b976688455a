/* splat/window_rows_lanes.h - windows of u16 and f32 voxels: eight voxels each of eight rows of the volume, from which taps are
 * taken by permutations. */
#ifndef HL_SPLAT_WINDOW_ROWS_LANES_H
#define HL_SPLAT_WINDOW_ROWS_LANES_H

#include "splat/window_parts_lanes.h"

/* ---- u16: two taps a word ---- */

/* From how far each lane's first tap lies from the window's first voxel: the places of its first two taps in the first row. */
LANES_INLINE __m512i index_u16(__m512i x, __m512i y) {
  __m512i first = _mm512_add_epi32(_mm512_slli_epi32(y, 3), x);
  return _mm512_add_epi32(_mm512_or_si512(first, _mm512_slli_epi32(first, 16)), _mm512_set1_epi32(0x00010000));
}

LANES_INLINE __m128i row_of_shorts(const unsigned char *row) { return _mm_loadu_si128((const __m128i *)row); }

LANES_INLINE window_slice slice_u16(const unsigned char *row, size_t row_bytes) {
  window_slice slice;
  for (int half = 0; half < 2; half++, row += 4 * row_bytes) {
    __m512i rows = _mm512_castsi128_si512(row_of_shorts(row));
    rows = _mm512_inserti32x4(rows, row_of_shorts(row + row_bytes), 1);
    rows = _mm512_inserti32x4(rows, row_of_shorts(row + 2 * row_bytes), 2);
    slice.part[half] = _mm512_inserti32x4(rows, row_of_shorts(row + 3 * row_bytes), 3);
  }
  return slice;
}

/* The four taps of every lane in row y of a slice. */
LANES_INLINE window_taps taps_u16(const window_slice *slice, __m512i index, int y) {
  __m512i first = _mm512_add_epi32(index, _mm512_set1_epi32(0x00080008 * y));
  __m512i third = _mm512_add_epi32(first, _mm512_set1_epi32(0x00020002));
  window_taps taps;
  taps.part[0] = _mm512_permutex2var_epi16(slice->part[0], first, slice->part[1]);
  taps.part[1] = _mm512_permutex2var_epi16(slice->part[0], third, slice->part[1]);
  return taps;
}

LANES_INLINE lanes weigh_u16(const window_taps *taps, const lanes weight[4]) {
  return weigh_words((lanes_int)taps->part[0], (lanes_int)taps->part[1], weight);
}

/* ---- f32 ---- */

LANES_INLINE __m512i index_f32(__m512i x, __m512i y) { return _mm512_add_epi32(_mm512_slli_epi32(y, 3), x); }

LANES_INLINE window_slice slice_f32(const unsigned char *row, size_t row_bytes) {
  window_slice slice;
  for (int pair = 0; pair < 4; pair++, row += 2 * row_bytes)
    slice.part[pair] = _mm512_inserti64x4(_mm512_castsi256_si512(_mm256_loadu_si256((const __m256i *)row)),
                                          _mm256_loadu_si256((const __m256i *)(row + row_bytes)), 1);
  return slice;
}

/* A permutation takes from four rows: lanes whose row is among the last four take from those. */
LANES_INLINE window_taps taps_f32(const window_slice *slice, __m512i index, int y) {
  __m512i at = _mm512_add_epi32(index, _mm512_set1_epi32(8 * y));
  __mmask16 below = _mm512_test_epi32_mask(at, _mm512_set1_epi32(32));
  window_taps taps;
  for (int tap = 0; tap < 4; tap++, at = _mm512_add_epi32(at, _mm512_set1_epi32(1)))
    taps.part[tap] = _mm512_mask_mov_epi32(_mm512_permutex2var_epi32(slice->part[0], at, slice->part[1]), below,
                                           _mm512_permutex2var_epi32(slice->part[2], at, slice->part[3]));
  return taps;
}

LANES_INLINE lanes weigh_f32(const window_taps *taps, const lanes weight[4]) {
  const __m512i *tap = taps->part;
  return weigh_floats((lanes)tap[0], (lanes)tap[1], (lanes)tap[2], (lanes)tap[3], weight);
}

#endif
