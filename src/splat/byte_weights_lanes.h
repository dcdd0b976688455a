/* splat/byte_weights_lanes.h - weighing u8 voxels along x. */
#ifndef HL_SPLAT_BYTE_WEIGHTS_LANES_H
#define HL_SPLAT_BYTE_WEIGHTS_LANES_H

#include "splat/whole_weights_lanes.h"

/* Four u8 taps a word, weighed and added: the weights are split as the processor multiplies. */
#if defined(__AVX512VBMI__) && defined(__AVX512VBMI2__) && defined(__AVX512VNNI__)
#define HL_PERMUTES_BYTES 1

/* A lane's four weights as two bytes each, the higher first. The processor multiplies bytes without a sign by
 * bytes with one: voxels less 128 by weights, and slopes by voxels. */
typedef struct byte_weights {
  __m512i digit[2];
} byte_weights;
typedef struct byte_slopes {
  __m512i digit[2];
} byte_slopes;

/* Of words of 16 bits, the taps 0 and 2 in one register and 1 and 3 in the other, the lower bytes and the
 * higher ones, in order. */
LANES_INLINE __m512i lower_bytes(__m512i even, __m512i odd) {
  return _mm512_ternarylogic_epi32(_mm512_set1_epi32(0x00ff00ff), even, _mm512_slli_epi32(odd, 8),
                                   0xca); /* a ? b : c */
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
  return (byte_slopes){
      {_mm512_xor_si512(higher_bytes(even, odd), sign), _mm512_xor_si512(lower_bytes(even, odd), sign)}};
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
/* Those of the taps 0 and 2 share a word, and those of 1 and 3: one instruction multiplies signed numbers of
 * 16 bits and adds the two products. */
typedef struct byte_weights {
  lanes_int pair[2];
} byte_weights;
typedef byte_weights byte_slopes;

LANES_INLINE byte_weights split_weights(const whole_weights *whole) {
  byte_weights weights;
  for (int i = 0; i < 2; i++) weights.pair[i] = (whole->tap[i] & 65535) | whole->tap[i + 2] << 16;
  return weights;
}
LANES_INLINE byte_slopes split_slopes(const whole_weights *whole) { return split_weights(whole); }

LANES_INLINE lanes_int weigh_bytes(lanes_int taps, const byte_weights *weights) {
  return lanes_multiply_shorts(taps & 0x00ff00ff, weights->pair[0]) +
         lanes_multiply_shorts((taps >> 8) & 0x00ff00ff, weights->pair[1]);
}
LANES_INLINE lanes_int slope_of_bytes(lanes_int taps, const byte_slopes *slopes) {
  return weigh_bytes(taps, slopes);
}
#else
typedef whole_weights byte_weights, byte_slopes;

LANES_INLINE byte_weights split_weights(const whole_weights *whole) { return *whole; }
LANES_INLINE byte_slopes split_slopes(const whole_weights *whole) { return *whole; }

LANES_INLINE lanes_int weigh_bytes(lanes_int taps, const byte_weights *weights) {
  return ((taps & 255) * weights->tap[0] + ((taps >> 8) & 255) * weights->tap[1]) +
         (((taps >> 16) & 255) * weights->tap[2] + ((taps >> 24) & 255) * weights->tap[3]);
}
LANES_INLINE lanes_int slope_of_bytes(lanes_int taps, const byte_slopes *slopes) {
  return weigh_bytes(taps, slopes);
}
#endif

#endif
