/* simd/packing.h - packs lanes: moves chosen lanes of a vector side by side, and back. */
#ifndef HL_SIMD_PACKING_H
#define HL_SIMD_PACKING_H

#include "simd/gathers.h"

#if !defined(__AVX512F__)
static const uint64_t NIBBLE_ONES = 0x1111111111111111u, NIBBLE_NUMBERS = 0xfedcba9876543210u;

/* Turns a word of sixteen numbers of four bits into sixteen lanes. */
LANES_INLINE lanes_int lanes_from_nibbles(uint64_t nibbles) {
  typedef uint32_t words __attribute__((vector_size(64)));
  uint32_t low = (uint32_t)nibbles, high = (uint32_t)(nibbles >> 32);
  const words shifts = {0, 4, 8, 12, 16, 20, 24, 28, 0, 4, 8, 12, 16, 20, 24, 28};
  words both = {low, low, low, low, low, low, low, low, high, high, high, high, high, high, high, high};
  return (lanes_int)(both >> shifts & 15);
}

/* Spreads sixteen bits over a word of 64 bits: each bit gets a nibble (four bits) of its own. */
LANES_INLINE uint64_t spread_bits(uint64_t bits) {
  bits = (bits | bits << 24) & 0x000000ff000000ffu;
  bits = (bits | bits << 12) & 0x000f000f000f000fu;
  bits = (bits | bits << 6) & 0x0303030303030303u;
  return (bits | bits << 3) & NIBBLE_ONES;
}

/* Moves the numbers of the chosen nibbles of a word into consecutive nibbles. Each number moves down by the
 * number of nibbles below it that are not chosen, in steps of one, two, four and eight nibbles (Warren,
 * "Hacker's Delight", compress). chosen: 1 in each chosen nibble. before: for each nibble, the number of
 * chosen nibbles below it. */
LANES_INLINE uint64_t chosen_numbers(uint64_t chosen, uint64_t before) {
  uint64_t all = chosen * 15, numbers = NIBBLE_NUMBERS & all, ways = (NIBBLE_NUMBERS - before) & all;
  for (int step = 0; step < 4; step++) {
    uint64_t moving = (ways >> step & NIBBLE_ONES) * 15, moved = numbers & moving, of_moved = ways & moving;
    numbers = (numbers ^ moved) | moved >> (4 << step);
    ways = (ways ^ of_moved) | of_moved >> (4 << step);
  }
  return numbers;
}
#endif

/* The moves by which the chosen lanes of sixteen come, in their order, to the lanes from `at` on. */
typedef struct lanes_packing {
#if defined(__AVX512F__)
  __m512i from; /* for each packed lane, the lane from which it comes */
  __m512i to;   /* for each chosen lane, the lane to which it goes */
  __mmask16 packed, bits;
#else
  lanes_int from, to, packed, bits;
#endif
} lanes_packing;

LANES_CALL lanes_packing lanes_packing_of(uint32_t bits, int at) {
  lanes_packing packing;
  uint32_t packed = ((1u << __builtin_popcount(bits)) - 1) << at;
#if defined(__AVX512F__)
  const __m512i first = _mm512_set_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
  packing.bits = (__mmask16)bits;
  packing.packed = (__mmask16)packed;
  packing.from = _mm512_maskz_expand_epi32(packing.packed, _mm512_maskz_compress_epi32(packing.bits, first));
  packing.to = _mm512_maskz_expand_epi32(packing.bits, _mm512_add_epi32(first, _mm512_set1_epi32(at)));
#else
  uint64_t chosen = spread_bits(bits),
           before = chosen * NIBBLE_ONES - chosen; /* in each nibble, the product is the sum of this nibble
                                                    * and all nibbles below it */
  packing.bits = lanes_from_bits(bits);
  packing.packed = lanes_from_bits(packed);
  packing.from = lanes_from_nibbles(chosen_numbers(chosen, before) << 4 * at);
  packing.to = lanes_from_nibbles(before + (unsigned)at * NIBBLE_ONES);
#endif
  return packing;
}

/* Packs lanes: returns `into`, in which the lanes from `at` on are replaced by the chosen lanes of x. */
LANES_CALL lanes lanes_pack(const lanes_packing *packing, lanes into, lanes x) {
#if defined(__AVX512F__)
  return (lanes)_mm512_mask_permutexvar_ps((__m512)into, packing->packed, packing->from, (__m512)x);
#else
  return lanes_select(packing->packed, (lanes)lanes_look_up((lanes_int)x, packing->from), into);
#endif
}

/* Unpacks lanes: moves packed lanes back to the lanes from which they came. All other lanes are 0. */
LANES_CALL lanes lanes_unpack(const lanes_packing *packing, lanes x) {
#if defined(__AVX512F__)
  return (lanes)_mm512_maskz_permutexvar_ps(packing->bits, packing->to, (__m512)x);
#else
  return lanes_keep(packing->bits, (lanes)lanes_look_up((lanes_int)x, packing->to));
#endif
}

#endif
