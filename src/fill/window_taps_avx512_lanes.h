/* fill/window_taps_avx512_lanes.h - holds one slice of a window of u16 or f32 voxels in registers of 512
 * bits, and takes taps from it by permutations. The slice has eight voxels of each of seven rows of the
 * volume. For u8 voxels see window_bytes_avx512_vbmi_lanes.h and window_words_avx512_lanes.h. */
#ifndef HL_FILL_WINDOW_TAPS_AVX512_LANES_H
#define HL_FILL_WINDOW_TAPS_AVX512_LANES_H

#include "fill/row_lanes.h"
#include "simd/lanes.h"

/* A slice of a window of voxels, in registers. The number of registers that are used depends on the voxels'
 * type. */
typedef struct window_slice {
  __m512i part[4];
} window_slice;
typedef struct window_taps {
  __m512i part[4];
} window_taps;

/* A set of lanes, as a mask for permutations: one bit for each unit that a permutation moves, such as a
 * byte. */
typedef __mmask64 window_lanes;

enum { WINDOW_ROWS = GRID_COLUMN - 1 }; /* number of rows in a window of u16 or f32 voxels */

/* ---- u16: two taps a word ---- */

/* The indices, in a slice of a window, of each lane's first two taps. x, y: the coordinates of each lane's
 * first tap in the window. */
LANES_INLINE __m512i index_u16(__m512i x, __m512i y) {
  __m512i first = _mm512_add_epi32(_mm512_slli_epi32(y, 3), x);
  return _mm512_add_epi32(_mm512_or_si512(first, _mm512_slli_epi32(first, 16)),
                          _mm512_set1_epi32(0x00010000));
}

LANES_INLINE __m128i row_of_shorts(const unsigned char *row) { return _mm_loadu_si128((const __m128i *)row); }

/* Loads a slice of a window of u16 voxels, and subtracts 32768 from the voxels. One register gets four rows,
 * and another register gets the three rows below these rows. */
LANES_INLINE window_slice slice_u16(const unsigned char *row, size_t row_bytes) {
  window_slice slice;
  __m512i upper = _mm512_castsi128_si512(row_of_shorts(row)),
          lower = _mm512_castsi128_si512(row_of_shorts(row + 4 * row_bytes));
  upper = _mm512_inserti32x4(upper, row_of_shorts(row + row_bytes), 1);
  lower = _mm512_inserti32x4(lower, row_of_shorts(row + 5 * row_bytes), 1);
  upper = _mm512_inserti32x4(upper, row_of_shorts(row + 2 * row_bytes), 2);
  lower = _mm512_inserti32x4(lower, row_of_shorts(row + 6 * row_bytes), 2);
  upper = _mm512_inserti32x4(upper, row_of_shorts(row + 3 * row_bytes), 3);
  slice.part[0] = _mm512_xor_si512(upper, _mm512_set1_epi32(VOXEL_SIGN));
  slice.part[1] = _mm512_xor_si512(lower, _mm512_set1_epi32(VOXEL_SIGN));
  return slice;
}

/* The four rows from row y on. The four rows hold tap row y of every lane, because the first tap of each lane
 * lies in one of the slice's first four rows. */
LANES_INLINE window_slice rows_u16(const window_slice *slice, int y) {
  window_slice rows;
  rows.part[0] = y == 0   ? slice->part[0]
                 : y == 1 ? _mm512_alignr_epi64(slice->part[1], slice->part[0], 2)
                 : y == 2 ? _mm512_alignr_epi64(slice->part[1], slice->part[0], 4)
                          : _mm512_alignr_epi64(slice->part[1], slice->part[0], 6);
  return rows;
}

LANES_INLINE __m512i third_u16(__m512i index) {
  return _mm512_add_epi32(index, _mm512_set1_epi32(0x00020002));
}

/* Takes the four taps of a row, for every lane, from rows of a slice. */
LANES_INLINE window_taps taps_u16(const window_slice *rows, __m512i index) {
  window_taps taps;
  taps.part[0] = _mm512_permutexvar_epi16(index, rows->part[0]);
  taps.part[1] = _mm512_permutexvar_epi16(third_u16(index), rows->part[0]);
  return taps;
}

/* The lanes whose first tap lies in slice number `slice` of a window. */
LANES_INLINE window_lanes starting_u16(__m512i start, int slice) {
  __m512i both = _mm512_or_si512(start, _mm512_slli_epi32(start, 16));
  return _mm512_cmpeq_epi16_mask(both, _mm512_set1_epi16((short)slice));
}

/* Replaces the taps of the lanes `some` by taps from another slice of the window. */
LANES_INLINE void replace_taps_u16(window_taps *taps, window_lanes some, const window_slice *rows,
                                   __m512i index) {
  taps->part[0] = _mm512_mask_permutexvar_epi16(taps->part[0], (__mmask32)some, index, rows->part[0]);
  taps->part[1] = _mm512_mask_permutexvar_epi16(taps->part[1], (__mmask32)some, third_u16(index),
                                                rows->part[0]);
}

LANES_INLINE lanes weigh_u16(const window_taps *taps, const short_weights *weights) {
  return lanes_from_int(weigh_signed((lanes_int)taps->part[0], (lanes_int)taps->part[1], weights));
}
LANES_INLINE lanes slope_u16(const window_taps *taps, const short_slopes *slopes) {
  return lanes_from_int(slope_of_signed((lanes_int)taps->part[0], (lanes_int)taps->part[1], slopes));
}

/* ---- f32 ---- */

LANES_INLINE __m512i index_f32(__m512i x, __m512i y) { return _mm512_add_epi32(_mm512_slli_epi32(y, 3), x); }

LANES_INLINE __m256i row_of_floats(const unsigned char *row) {
  return _mm256_loadu_si256((const __m256i *)row);
}

/* Loads a slice of a window of f32 voxels: seven rows, two in each register. */
LANES_INLINE window_slice slice_f32(const unsigned char *row, size_t row_bytes) {
  window_slice slice;
  for (int pair = 0; pair < 3; pair++, row += 2 * row_bytes)
    slice.part[pair] = _mm512_inserti64x4(_mm512_castsi256_si512(row_of_floats(row)),
                                          row_of_floats(row + row_bytes), 1);
  slice.part[3] = _mm512_castsi256_si512(row_of_floats(row));
  return slice;
}

/* The two rows of a slice from row y on. */
LANES_INLINE __m512i rows_f32(const window_slice *slice, int y) {
  const __m512i *pair = slice->part + y / 2;
  return y % 2 == 0 ? pair[0] : _mm512_alignr_epi64(pair[1], pair[0], 4);
}

/* Takes the four taps of every lane in tap row y. The taps lie in the four rows from row y on. */
LANES_INLINE window_taps taps_f32(const window_slice *slice, __m512i index, int y) {
  __m512i upper = rows_f32(slice, y), lower = rows_f32(slice, y + 2);
  window_taps taps;
  for (int tap = 0; tap < 4; tap++)
    taps.part[tap] = _mm512_permutex2var_epi32(upper, _mm512_add_epi32(index, _mm512_set1_epi32(tap)), lower);
  return taps;
}

LANES_INLINE lanes weigh_f32(const window_taps *taps, const lanes weight[4]) {
  const __m512i *tap = taps->part;
  return weigh_floats((lanes)tap[0], (lanes)tap[1], (lanes)tap[2], (lanes)tap[3], weight);
}

#endif
