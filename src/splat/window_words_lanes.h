/* splat/window_words_lanes.h - a window's taps by permutations of 32-bit words, weighed by dot products of 16-bit words. */
#ifndef HL_SPLAT_WINDOW_WORDS_LANES_H
#define HL_SPLAT_WINDOW_WORDS_LANES_H

#include "splat/window_parts_lanes.h"

enum { WINDOW_WIDTH = GRID_COLUMN - 1 }; /* voxels along x that taps are taken from */

/* From how far each lane's first tap lies from the window's first voxel. */
LANES_INLINE __m512i index_u8(__m512i x, __m512i y) {
  __m512i pair = _mm512_slli_epi32(_mm512_srli_epi32(x, 1), 4), second = _mm512_and_si512(x, _mm512_set1_epi32(1));
  return _mm512_or_si512(_mm512_or_si512(pair, second), _mm512_slli_epi32(y, 1));
}

/* The rows that begin so many bits after those of the left column: of each of them the four voxels from its first one on and
 * from its second one on in turn, and the same from its third and fourth. Every lane's taps are one of these 32 words. */
LANES_INLINE window_slice join_columns(__m512i left, __m512i right, __m512i shift) {
  const __mmask16 odd = 0xaaaa;
  __m512i rows = _mm512_or_si512(_mm512_srlv_epi64(left, shift), _mm512_sllv_epi64(right, _mm512_sub_epi64(_mm512_set1_epi64(64), shift)));
  window_slice slice;
  slice.part[0] = _mm512_mask_mov_epi32(rows, odd, _mm512_slli_epi64(rows, 24));
  slice.part[1] = _mm512_mask_mov_epi32(_mm512_srli_epi64(rows, 16), odd, _mm512_slli_epi64(rows, 8));
  return slice;
}

/* The four taps of every lane in row y of a slice. */
LANES_INLINE window_taps taps_u8(const window_slice *slice, __m512i index, int y) {
  window_taps taps;
  taps.part[0] = _mm512_permutex2var_epi32(slice->part[0], _mm512_add_epi32(index, _mm512_set1_epi32(2 * y)), slice->part[1]);
  return taps;
}

/* A lane's four weights as two signed numbers of 16 bits each: whole = high 2^11 + low. Those of the taps 0 and 2 share a word, and
 * those of 1 and 3. */
typedef struct split_weights { __m512i high[2], low[2]; } split_weights;

LANES_INLINE __m512i two_words(__m512i first, __m512i second) {
  return _mm512_mask_blend_epi16(0xaaaaaaaau, first, _mm512_slli_epi32(second, 16));
}

LANES_INLINE split_weights split_whole(const whole_weights *whole) {
  const __m512i below = _mm512_set1_epi32((1 << 11) - 1);
  split_weights weights;
  for (int i = 0; i < 2; i++) {
    __m512i first = (__m512i)whole->tap[i], second = (__m512i)whole->tap[i + 2];
    weights.high[i] = two_words(_mm512_srai_epi32(first, 11), _mm512_srai_epi32(second, 11));
    weights.low[i] = two_words(_mm512_and_si512(first, below), _mm512_and_si512(second, below));
  }
  return weights;
}

LANES_INLINE lanes weigh_u8(const window_taps *taps, const split_weights *weights) {
  const __m512i even_bytes = _mm512_set1_epi32(0x00ff00ff);
  __m512i even = _mm512_and_si512(taps->part[0], even_bytes), odd = _mm512_and_si512(_mm512_srli_epi32(taps->part[0], 8), even_bytes);
  __m512i high = _mm512_add_epi32(_mm512_madd_epi16(even, weights->high[0]), _mm512_madd_epi16(odd, weights->high[1]));
  __m512i low = _mm512_add_epi32(_mm512_madd_epi16(even, weights->low[0]), _mm512_madd_epi16(odd, weights->low[1]));
  return lanes_from_int((lanes_int)_mm512_add_epi32(_mm512_slli_epi32(high, 11), low));
}

#endif
