/* simd/narrow.h - defines sixteen small numbers in 16 or 8 bits each, for AVX2. The packing instructions
 * order lanes as 0-3, 8-11, 4-7, 12-15. */
#ifndef HL_SIMD_NARROW_H
#define HL_SIMD_NARROW_H

#include "simd/gathers.h"

#if defined(__AVX2__) && !defined(__AVX512F__)
/* Narrows lanes to 16 bits each. Numbers that do not fit are clamped. */
LANES_INLINE __m256i narrow_shorts(lanes_int x) {
  __m256i half[2];
  memcpy(half, &x, sizeof half);
  return _mm256_packs_epi32(half[0], half[1]);
}
/* Narrows lanes to 8 bits each. Numbers that do not fit are clamped. */
LANES_INLINE __m128i narrow_bytes(lanes_int x) {
  __m256i shorts = narrow_shorts(x);
  return _mm_packs_epi16(_mm256_castsi256_si128(shorts), _mm256_extracti128_si256(shorts, 1));
}

/* Returns whether any of sixteen numbers of 16 bits, taken as an unsigned number, is above a limit. */
LANES_INLINE int any_short_above(__m256i x, int limit) {
  __m256i above = _mm256_subs_epu16(x, _mm256_set1_epi16((short)limit));
  return !_mm256_testz_si256(above, above);
}

/* Sixteen numbers of 16 bits in memory, in the order in which they are packed. narrow_pair() points at the
 * number of lane k in a half of the lanes. The number of lane k + 4 of this half lies NARROW_SECOND numbers
 * after the number of lane k. */
typedef struct narrow_offsets {
  _Alignas(32) uint16_t at[LANES];
} narrow_offsets;

LANES_INLINE void narrow_store(narrow_offsets *offsets, __m256i shorts) {
  memcpy(offsets->at, &shorts, sizeof offsets->at);
  /* keeps the compiler from holding the numbers in a register, as in lanes_store_offsets() */
  __asm__ volatile("" : : "r"(offsets) : "memory");
}
LANES_INLINE const uint16_t *narrow_pair(const narrow_offsets *offsets, int half, int k) {
  return offsets->at + 4 * half + k;
}
enum { NARROW_SECOND = 8 };
#endif

#endif
