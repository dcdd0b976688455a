/* fill/window_words_avx512_lanes.h - takes taps of u8 voxels out of a window of voxels by permutations of
 * 32-bit words, for processors with AVX-512 that cannot permute bytes. */
#ifndef HL_FILL_WINDOW_WORDS_AVX512_LANES_H
#define HL_FILL_WINDOW_WORDS_AVX512_LANES_H

#include "fill/window_taps_avx512_lanes.h"

enum { WINDOW_WIDTH = GRID_COLUMN - 1 }; /* number of voxels along x among which taps are looked up */

/* The index, in a slice of a window, of the word that holds each lane's taps in tap row 0. x, y: the
 * coordinates of each lane's first tap in the window. */
LANES_INLINE __m512i index_u8(__m512i x, __m512i y) {
  __m512i pair = _mm512_slli_epi32(_mm512_srli_epi32(x, 1), 4),
          second = _mm512_and_si512(x, _mm512_set1_epi32(1));
  return _mm512_or_si512(_mm512_or_si512(pair, second), _mm512_slli_epi32(y, 1));
}

/* Joins a left and a right column to eight rows of eight voxels, as words of four voxels. The rows begin
 * `shift` bits after the left column's first voxel. Each row gives four words: the words that begin at its
 * voxels 0 and 1 go to the first register, the words that begin at its voxels 2 and 3 to the second. Each
 * lane's four taps are one of these 32 words. */
LANES_INLINE window_slice join_columns(__m512i left, __m512i right, __m512i shift) {
  const __mmask16 odd = 0xaaaa;
  __m512i rows = _mm512_or_si512(_mm512_srlv_epi64(left, shift),
                                 _mm512_sllv_epi64(right, _mm512_sub_epi64(_mm512_set1_epi64(64), shift)));
  /* adds 128, because 128 was subtracted from the voxels in the columns */
  rows = _mm512_xor_si512(rows, _mm512_set1_epi8((char)0x80));
  window_slice slice;
  slice.part[0] = _mm512_mask_mov_epi32(rows, odd, _mm512_slli_epi64(rows, 24));
  slice.part[1] = _mm512_mask_mov_epi32(_mm512_srli_epi64(rows, 16), odd, _mm512_slli_epi64(rows, 8));
  return slice;
}

/* The indices, in a slice of a window, of the words that hold the taps in tap row y. */
LANES_INLINE __m512i index_in_row_u8(__m512i index, int y) {
  return _mm512_add_epi32(index, _mm512_set1_epi32(2 * y));
}

/* Takes the four taps of a row, for every lane, from a slice of a window. */
LANES_INLINE window_taps taps_u8(const window_slice *slice, __m512i index) {
  window_taps taps;
  taps.part[0] = _mm512_permutex2var_epi32(slice->part[0], index, slice->part[1]);
  return taps;
}

LANES_INLINE lanes weigh_u8(const window_taps *taps, const byte_weights *weights) {
  return lanes_from_int(weigh_bytes((lanes_int)taps->part[0], weights));
}
LANES_INLINE lanes slope_u8(const window_taps *taps, const byte_slopes *slopes) {
  return lanes_from_int(slope_of_bytes((lanes_int)taps->part[0], slopes));
}

/* The lanes whose first tap lies in slice number `slice` of a window. */
LANES_INLINE window_lanes starting_u8(__m512i start, int slice) {
  return _mm512_cmpeq_epi32_mask(start, _mm512_set1_epi32(slice));
}

/* Replaces the taps of the lanes `some` by taps from another slice of the window. */
LANES_INLINE void replace_taps_u8(window_taps *taps, window_lanes some, const window_slice *slice,
                                  __m512i index) {
  taps->part[0] = _mm512_mask_mov_epi32(taps->part[0], (__mmask16)some, taps_u8(slice, index).part[0]);
}

#endif
