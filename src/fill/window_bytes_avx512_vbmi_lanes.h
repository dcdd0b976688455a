/* fill/window_bytes_avx512_vbmi_lanes.h - takes taps of u8 voxels out of a window of voxels by permutations
 * of bytes (AVX-512 VBMI). */
#ifndef HL_FILL_WINDOW_BYTES_AVX512_VBMI_LANES_H
#define HL_FILL_WINDOW_BYTES_AVX512_VBMI_LANES_H

#include "fill/window_taps_avx512_lanes.h"

enum { WINDOW_WIDTH = GRID_COLUMN }; /* number of voxels along x among which taps are looked up */

/* Copies each lane's lowest byte into all four of its bytes. */
LANES_INLINE __m512i repeat_bytes(__m512i x) {
  return _mm512_shuffle_epi8(x, _mm512_set4_epi32(0x0c0c0c0c, 0x08080808, 0x04040404, 0));
}

/* The index, in a slice of a window of voxels, of each lane's taps in tap row 0; one byte for each tap. x, y:
 * the coordinates of each lane's first tap in the window. */
LANES_INLINE __m512i index_u8(__m512i x, __m512i y) {
  __m512i first = _mm512_add_epi32(_mm512_slli_epi32(y, 3), x);
  return _mm512_add_epi8(repeat_bytes(first), _mm512_set1_epi32(0x03020100));
}

/* Joins a left and a right column of eight rows of voxels, and takes eight voxels out of each row. A row
 * begins `shift` bits after the left column's first voxel. */
LANES_INLINE window_slice join_columns(__m512i left, __m512i right, __m512i shift) {
  window_slice slice;
  slice.part[0] = _mm512_shrdv_epi64(left, right, shift);
  return slice;
}

/* The indices, in a slice of a window, of the taps in tap row y. */
LANES_INLINE __m512i index_in_row_u8(__m512i index, int y) {
  return _mm512_add_epi8(index, _mm512_set1_epi8((char)(GRID_COLUMN * y)));
}

/* Takes the four taps of a row, for every lane, from a slice of a window. */
LANES_INLINE window_taps taps_u8(const window_slice *slice, __m512i index) {
  window_taps taps;
  taps.part[0] = _mm512_permutexvar_epi8(index, slice->part[0]);
  return taps;
}

/* Weighs the four taps of every lane. The columns, and so the taps, hold voxels from which 128 was
 * subtracted. */
LANES_INLINE lanes weigh_u8(const window_taps *taps, const byte_weights *weights) {
  return lanes_from_int(weigh_signed_bytes((lanes_int)taps->part[0], weights));
}
LANES_INLINE lanes slope_u8(const window_taps *taps, const byte_slopes *slopes) {
  return lanes_from_int(slope_of_bytes(taps_with_sign((lanes_int)taps->part[0]), slopes));
}

/* The lanes whose first tap lies in slice number `slice` of a window. */
LANES_INLINE window_lanes starting_u8(__m512i start, int slice) {
  return _mm512_cmpeq_epi8_mask(repeat_bytes(start), _mm512_set1_epi8((char)slice));
}

/* Replaces the taps of the lanes `some` by taps from another slice of the window. */
LANES_INLINE void replace_taps_u8(window_taps *taps, window_lanes some, const window_slice *slice,
                                  __m512i index) {
  taps->part[0] = _mm512_mask_permutexvar_epi8(taps->part[0], some, index, slice->part[0]);
}

#endif
