/* splat/byte_weights_lanes.h - weights along x of u8 voxels, as whole numbers. */
#ifndef HL_SPLAT_BYTE_WEIGHTS_LANES_H
#define HL_SPLAT_BYTE_WEIGHTS_LANES_H

#include "simd/lanes.h"

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

/* Four u8 taps a word, weighed and added: the weights are split as the processor multiplies. */
#if defined(__AVX512VBMI__) && defined(__AVX512VBMI2__) && defined(__AVX512VNNI__)
#define HL_PERMUTES_BYTES 1

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

LANES_INLINE lanes_int weigh_bytes(lanes_int taps, const byte_weights *weights) {
  __m512i sum = _mm512_dpbusd_epi32(_mm512_setzero_si512(), (__m512i)taps, weights->digit[0]);
  sum = _mm512_dpbusd_epi32(_mm512_slli_epi32(sum, 8), (__m512i)taps, weights->digit[1]);
  return (lanes_int)_mm512_dpbusd_epi32(_mm512_slli_epi32(sum, 8), (__m512i)taps, weights->digit[2]);
}
#elif defined(__AVX2__)
/* A lane's four weights as two signed numbers of 16 bits each: whole = high 2^11 + low. Those of the taps 0 and 2 share a word, and
 * those of 1 and 3: one instruction multiplies both and adds. */
typedef struct byte_weights { lanes_int high[2], low[2]; } byte_weights;

LANES_INLINE lanes_int two_shorts(lanes_int first, lanes_int second) { return (first & 65535) | (second << 16); }

LANES_INLINE byte_weights split_weights(const whole_weights *whole) {
  byte_weights weights;
  for (int i = 0; i < 2; i++) {
    lanes_int first = whole->tap[i], second = whole->tap[i + 2];
    weights.high[i] = two_shorts(first >> 11, second >> 11);
    weights.low[i] = two_shorts(first & 2047, second & 2047);
  }
  return weights;
}

LANES_INLINE lanes_int weigh_bytes(lanes_int taps, const byte_weights *weights) {
  lanes_int even = taps & 0x00ff00ff, odd = (taps >> 8) & 0x00ff00ff;
  lanes_int high = lanes_multiply_shorts(even, weights->high[0]) + lanes_multiply_shorts(odd, weights->high[1]);
  lanes_int low = lanes_multiply_shorts(even, weights->low[0]) + lanes_multiply_shorts(odd, weights->low[1]);
  return (high << 11) + low;
}
#else
typedef whole_weights byte_weights;

LANES_INLINE byte_weights split_weights(const whole_weights *whole) { return *whole; }

LANES_INLINE lanes_int weigh_bytes(lanes_int taps, const byte_weights *weights) {
  return ((taps & 255) * weights->tap[0] + ((taps >> 8) & 255) * weights->tap[1]) +
         (((taps >> 16) & 255) * weights->tap[2] + ((taps >> 24) & 255) * weights->tap[3]);
}
#endif

#endif
