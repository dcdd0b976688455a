/* splat/window_bytes_lanes.h - a window's taps of u8 voxels by permutations of bytes. */
#ifndef HL_SPLAT_WINDOW_BYTES_LANES_H
#define HL_SPLAT_WINDOW_BYTES_LANES_H

#include "splat/window_parts_lanes.h"

enum { WINDOW_WIDTH = GRID_COLUMN }; /* voxels along x that taps are taken from */

/* The lowest byte of each lane in all four. */
LANES_INLINE __m512i repeat_bytes(__m512i x) {
  return _mm512_shuffle_epi8(x, _mm512_set4_epi32(0x0c0c0c0c, 0x08080808, 0x04040404, 0));
}

/* From how far each lane's first tap lies from the window's first voxel: a byte for each tap's place in the
 * first row. */
LANES_INLINE __m512i index_u8(__m512i x, __m512i y) {
  __m512i first = _mm512_add_epi32(_mm512_slli_epi32(y, 3), x);
  return _mm512_add_epi8(repeat_bytes(first), _mm512_set1_epi32(0x03020100));
}

/* The rows that begin so many bits after those of the left column. */
LANES_INLINE window_slice join_columns(__m512i left, __m512i right, __m512i shift) {
  window_slice slice;
  slice.part[0] = _mm512_shrdv_epi64(left, right, shift);
  return slice;
}

/* The same in row y of a slice. */
LANES_INLINE __m512i index_in_row_u8(__m512i index, int y) {
  return _mm512_add_epi8(index, _mm512_set1_epi8((char)(GRID_COLUMN * y)));
}

/* The four taps of every lane. */
LANES_INLINE window_taps taps_u8(const window_slice *slice, __m512i index) {
  window_taps taps;
  taps.part[0] = _mm512_permutexvar_epi8(index, slice->part[0]);
  return taps;
}

/* In columns voxels are less 128. */
LANES_INLINE lanes weigh_u8(const window_taps *taps, const byte_weights *weights) {
  return lanes_from_int(weigh_signed_bytes((lanes_int)taps->part[0], weights));
}
LANES_INLINE lanes slope_u8(const window_taps *taps, const byte_slopes *slopes) {
  return lanes_from_int(slope_of_bytes(taps_with_sign((lanes_int)taps->part[0]), slopes));
}

/* The lanes whose taps begin in a slice. */
LANES_INLINE window_lanes starting_u8(__m512i start, int slice) {
  return _mm512_cmpeq_epi8_mask(repeat_bytes(start), _mm512_set1_epi8((char)slice));
}

/* Some lanes' taps from another slice. */
LANES_INLINE void replace_taps_u8(window_taps *taps, window_lanes some, const window_slice *slice,
                                  __m512i index) {
  taps->part[0] = _mm512_mask_permutexvar_epi8(taps->part[0], some, index, slice->part[0]);
}

#endif
