/* splat/window_bytes_lanes.h - a window's taps by permutations of bytes, weighed by dot products of bytes. */
#ifndef HL_SPLAT_WINDOW_BYTES_LANES_H
#define HL_SPLAT_WINDOW_BYTES_LANES_H

#include "splat/window_parts_lanes.h"

enum { WINDOW_WIDTH = GRID_COLUMN }; /* voxels along x that taps are taken from */

/* From how far each lane's first tap lies from the window's first voxel: a byte for each tap's place in the first row. */
LANES_INLINE __m512i index_u8(__m512i x, __m512i y) {
  __m512i first = _mm512_add_epi32(_mm512_slli_epi32(y, 3), x);
  const __m512i lowest_byte = _mm512_set4_epi32(0x0c0c0c0c, 0x08080808, 0x04040404, 0);
  return _mm512_add_epi8(_mm512_shuffle_epi8(first, lowest_byte), _mm512_set1_epi32(0x03020100));
}

/* The rows that begin so many bits after those of the left column. */
LANES_INLINE window_slice join_columns(__m512i left, __m512i right, __m512i shift) {
  window_slice slice;
  slice.part[0] = _mm512_shrdv_epi64(left, right, shift);
  return slice;
}

/* The four taps of every lane in row y of a slice. */
LANES_INLINE window_taps taps_u8(const window_slice *slice, __m512i index, int y) {
  window_taps taps;
  taps.part[0] = _mm512_permutexvar_epi8(_mm512_add_epi8(index, _mm512_set1_epi8((char)(GRID_COLUMN * y))), slice->part[0]);
  return taps;
}

/* A lane's four weights as three signed bytes each, the highest first: whole = (d0 256 + d1) 256 + d2. */
typedef struct slice_weights { __m512i digit[3]; } slice_weights;

LANES_INLINE slice_weights weights_of_slices(const whole_weights *whole) {
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
  slice_weights weights;
  weights.digit[2] = _mm512_xor_si512(_mm512_permutex2var_epi8(low, first, high), sign);
  weights.digit[1] = _mm512_xor_si512(_mm512_permutex2var_epi8(low, second, high), sign);
  weights.digit[0] = _mm512_xor_si512(_mm512_permutex2var_epi8(low_top, first, high_top), sign);
  return weights;
}

LANES_INLINE lanes weigh_u8(const window_taps *taps, const slice_weights *weights) {
  __m512i sum = _mm512_dpbusd_epi32(_mm512_setzero_si512(), taps->part[0], weights->digit[0]);
  sum = _mm512_dpbusd_epi32(_mm512_slli_epi32(sum, 8), taps->part[0], weights->digit[1]);
  sum = _mm512_dpbusd_epi32(_mm512_slli_epi32(sum, 8), taps->part[0], weights->digit[2]);
  return lanes_from_int((lanes_int)sum);
}

#endif
