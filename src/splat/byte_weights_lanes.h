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

/* Of each byte, the source whose mask has it; no byte is in two masks. */
LANES_INLINE __m512i take_bytes(const __m512i packed[3], int32_t first, int32_t second, int32_t third) {
  __m512i some = _mm512_ternarylogic_epi32(_mm512_and_si512(packed[0], _mm512_set1_epi32(first)), packed[1], _mm512_set1_epi32(second), 0xf8);
  return _mm512_ternarylogic_epi32(some, packed[2], _mm512_set1_epi32(third), 0xf8); /* a | (b & c) */
}

LANES_INLINE byte_weights split_weights(const whole_weights *whole) {
  __m512i biased[4], packed[3];
  const __m512i bias = _mm512_set1_epi32(0x808080), sign = _mm512_set1_epi32((int)0x80808080);
  for (int tap = 0; tap < 4; tap++) biased[tap] = _mm512_add_epi32((__m512i)whole->tap[tap], bias);
  /* three bytes of each of the taps A to D, from the lowest on: A0 A1 A2 B0, B1 B2 C0 C1, C2 D0 D1 D2 */
  packed[0] = _mm512_or_si512(biased[0], _mm512_slli_epi32(biased[1], 24));
  packed[1] = _mm512_or_si512(_mm512_srli_epi32(biased[1], 8), _mm512_slli_epi32(biased[2], 16));
  packed[2] = _mm512_or_si512(_mm512_srli_epi32(biased[2], 16), _mm512_slli_epi32(biased[3], 8));
  /* of the four one digit each, which are in different bytes: A0 D0 C0 B0, B1 A1 D1 C1, C2 B2 A2 D2; then in order */
  const __m512i lowest = _mm512_set4_epi32(0x0d0e0f0c, 0x090a0b08, 0x05060704, 0x01020300);
  const __m512i middle = _mm512_set4_epi32(0x0e0f0c0d, 0x0a0b0809, 0x06070405, 0x02030001);
  const __m512i highest = _mm512_set4_epi32(0x0f0c0d0e, 0x0b08090a, 0x07040506, 0x03000102);
  byte_weights weights;
  weights.digit[2] = _mm512_xor_si512(_mm512_shuffle_epi8(take_bytes(packed, (int32_t)0xff0000ff, 0x00ff0000, 0x0000ff00), lowest), sign);
  weights.digit[1] = _mm512_xor_si512(_mm512_shuffle_epi8(take_bytes(packed, 0x0000ff00, (int32_t)0xff0000ff, 0x00ff0000), middle), sign);
  weights.digit[0] = _mm512_xor_si512(_mm512_shuffle_epi8(take_bytes(packed, 0x00ff0000, 0x0000ff00, (int32_t)0xff0000ff), highest), sign);
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
