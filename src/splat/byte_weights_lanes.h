/* splat/byte_weights_lanes.h - weights along x of u8 voxels, as whole numbers. */
#ifndef HL_SPLAT_BYTE_WEIGHTS_LANES_H
#define HL_SPLAT_BYTE_WEIGHTS_LANES_H

#include "simd/lanes.h"

/* Weights along x as whole numbers, so that sums of u8 taps are exact whatever the instruction set. Each is two bytes, and a
 * sum of four taps, 255 * 65534 at most, is a float too. Slopes, the derivatives of weights, are signed; of all kernels' they and
 * their sums stay below 1.08. */
enum { WEIGHT_UNITS = 65534, SLOPE_UNITS = 30000 };
static const float WEIGHT_INVERSE = 1.0f / WEIGHT_UNITS, SLOPE_INVERSE = 1.0f / SLOPE_UNITS;

typedef struct whole_weights { lanes_int tap[4]; } whole_weights;

/* x units, rounded to the nearest whole number below 2^22: of a float from 2^23 to 2^24 a unit is the last bit, and adding
 * rounds to it. */
LANES_INLINE lanes_int round_to_units(lanes x, int units) {
  const float whole = 3 << 22;
  return (lanes_int)lanes_line(x, (float)units, whole) - (lanes_int)lanes_set(whole);
}

/* The sums from the first tap on are rounded, not the taps: what a row of voxels is then off by is half a unit of the
 * differences between neighbours, and constant rows are exact. total: of the four. */
LANES_INLINE whole_weights round_weights(const lanes weight[4], int units, int total) {
  lanes_int first = round_to_units(weight[0], units), two = round_to_units(weight[0] + weight[1], units);
  lanes_int last = round_to_units(weight[3], units);
  return (whole_weights){{first, two - first, total * units - last - two, last}};
}

/* The weights that u8 voxels get, as floats. */
LANES_INLINE void round_to_weights(lanes weight[4]) {
  whole_weights whole = round_weights(weight, WEIGHT_UNITS, 1);
  for (int tap = 0; tap < 4; tap++) weight[tap] = lanes_from_int(whole.tap[tap]) * WEIGHT_INVERSE;
}

/* Four u8 taps a word, weighed and added: the weights are split as the processor multiplies. */
#if defined(__AVX512VBMI__) && defined(__AVX512VBMI2__) && defined(__AVX512VNNI__)
#define HL_PERMUTES_BYTES 1

/* A lane's four weights as two bytes each, the higher first. The processor multiplies bytes without a sign by bytes with one:
 * voxels less 128 by weights, and slopes by voxels. */
typedef struct byte_weights { __m512i digit[2]; } byte_weights;
typedef struct byte_slopes { __m512i digit[2]; } byte_slopes;

/* Of words of 16 bits, the taps 0 and 2 in one register and 1 and 3 in the other, the lower bytes and the higher ones, in order. */
LANES_INLINE __m512i lower_bytes(__m512i even, __m512i odd) {
  return _mm512_ternarylogic_epi32(_mm512_set1_epi32(0x00ff00ff), even, _mm512_slli_epi32(odd, 8), 0xca); /* a ? b : c */
}
LANES_INLINE __m512i higher_bytes(__m512i even, __m512i odd) {
  return _mm512_ternarylogic_epi32(_mm512_set1_epi32(0x00ff00ff), _mm512_srli_epi32(even, 8), odd, 0xca);
}
LANES_INLINE __m512i two_words(lanes_int first, lanes_int second) {
  return _mm512_mask_blend_epi16(0xaaaaaaaa, (__m512i)first, _mm512_slli_epi32((__m512i)second, 16));
}

LANES_INLINE byte_weights split_weights(const whole_weights *whole) {
  __m512i even = two_words(whole->tap[0], whole->tap[2]), odd = two_words(whole->tap[1], whole->tap[3]);
  return (byte_weights){{higher_bytes(even, odd), lower_bytes(even, odd)}};
}

/* whole = d0 256 + d1, both with a sign: the lower byte's is carried from the higher. */
LANES_INLINE byte_slopes split_slopes(const whole_weights *whole) {
  const __m512i sign = _mm512_set1_epi16((short)0x8080);
  __m512i even = _mm512_add_epi16(two_words(whole->tap[0], whole->tap[2]), sign);
  __m512i odd = _mm512_add_epi16(two_words(whole->tap[1], whole->tap[3]), sign);
  return (byte_slopes){{_mm512_xor_si512(higher_bytes(even, odd), sign), _mm512_xor_si512(lower_bytes(even, odd), sign)}};
}

/* Voxels less 128, and back. */
LANES_INLINE lanes_int taps_with_sign(lanes_int taps) { return taps ^ (int32_t)0x80808080; }

LANES_INLINE lanes_int weigh_signed_bytes(lanes_int less_128, const byte_weights *weights) {
  const __m512i half = _mm512_set1_epi32(WEIGHT_UNITS / 2); /* 128 times all weights, less a byte */
  __m512i sum = _mm512_dpbusd_epi32(half, weights->digit[0], (__m512i)less_128);
  return (lanes_int)_mm512_dpbusd_epi32(_mm512_slli_epi32(sum, 8), weights->digit[1], (__m512i)less_128);
}
LANES_INLINE lanes_int weigh_bytes(lanes_int taps, const byte_weights *weights) {
  return weigh_signed_bytes(taps_with_sign(taps), weights);
}
LANES_INLINE lanes_int slope_of_bytes(lanes_int taps, const byte_slopes *slopes) {
  __m512i sum = _mm512_dpbusd_epi32(_mm512_setzero_si512(), (__m512i)taps, slopes->digit[0]);
  return (lanes_int)_mm512_dpbusd_epi32(_mm512_slli_epi32(sum, 8), (__m512i)taps, slopes->digit[1]);
}
#elif defined(__AVX2__)
/* Those of the taps 0 and 2 share a word, and those of 1 and 3: one instruction multiplies signed numbers of 16 bits and adds the
 * two products. Weights above 32767 are less that much there, and biased: a byte a tap, which gives it back. */
enum { BIAS = 7, BIAS_UNITS = 32767 / BIAS };
typedef struct byte_weights { lanes_int pair[2], bias; } byte_weights;
typedef struct byte_slopes { lanes_int pair[2]; } byte_slopes;

LANES_INLINE byte_slopes split_slopes(const whole_weights *whole) {
  byte_slopes slopes;
  for (int i = 0; i < 2; i++) slopes.pair[i] = (whole->tap[i] & 65535) | whole->tap[i + 2] << 16;
  return slopes;
}

LANES_INLINE byte_weights split_weights(const whole_weights *whole) {
  typedef int16_t shorts __attribute__((vector_size(64)));
  byte_slopes both = split_slopes(whole);
  byte_weights weights = {.bias = lanes_set_int(0)};
  for (int i = 0; i < 2; i++) {
    shorts pair = (shorts)both.pair[i], above = pair >> 15; /* all bits, which are -1, or none */
    weights.pair[i] = (lanes_int)((pair & 0x7fff) - above);
    weights.bias |= (lanes_int)above & (BIAS * 0x00010001) << 8 * i;
  }
  return weights;
}

LANES_INLINE lanes_int multiply_pairs(lanes_int taps, const lanes_int pair[2]) {
  return lanes_multiply_shorts(taps & 0x00ff00ff, pair[0]) + lanes_multiply_shorts((taps >> 8) & 0x00ff00ff, pair[1]);
}
LANES_INLINE lanes_int weigh_bytes(lanes_int taps, const byte_weights *weights) {
  lanes_int biased = lanes_multiply_shorts(lanes_multiply_bytes(taps, weights->bias), lanes_set_int(BIAS_UNITS * 0x00010001));
  return multiply_pairs(taps, weights->pair) + biased;
}
LANES_INLINE lanes_int slope_of_bytes(lanes_int taps, const byte_slopes *slopes) { return multiply_pairs(taps, slopes->pair); }
#else
typedef whole_weights byte_weights, byte_slopes;

LANES_INLINE byte_weights split_weights(const whole_weights *whole) { return *whole; }
LANES_INLINE byte_slopes split_slopes(const whole_weights *whole) { return *whole; }

LANES_INLINE lanes_int weigh_bytes(lanes_int taps, const byte_weights *weights) {
  return ((taps & 255) * weights->tap[0] + ((taps >> 8) & 255) * weights->tap[1]) +
         (((taps >> 16) & 255) * weights->tap[2] + ((taps >> 24) & 255) * weights->tap[3]);
}
LANES_INLINE lanes_int slope_of_bytes(lanes_int taps, const byte_slopes *slopes) { return weigh_bytes(taps, slopes); }
#endif

#endif
