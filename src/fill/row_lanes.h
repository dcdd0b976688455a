/* fill/row_lanes.h - weights and adds four neighbouring voxels along x, for each of sixteen lanes. */
#ifndef HL_FILL_ROW_LANES_H
#define HL_FILL_ROW_LANES_H

#include "core/sheet_constants.h"
#include "grid/grid.h"
#include "simd/gathers.h"

/* ---- weights as integers ---- */

/* Weights and slopes are rounded to integers, in units of 1 / WEIGHT_UNITS and 1 / SLOPE_UNITS. These
 * constants convert the integers to floats. */
static const float WEIGHT_INVERSE = 1.0f / WEIGHT_UNITS, SLOPE_INVERSE = 1.0f / SLOPE_UNITS;

typedef struct integer_weights {
  lanes_int tap[4];
} integer_weights;

/* Returns the product of x and `units`, rounded to the nearest integer. Results are below 2^22. The last bit
 * of a float from 2^23 to 2^24 stands for 1, so that adding 3 * 2^22 rounds x * units to an integer. */
LANES_INLINE lanes_int round_to_units(lanes x, int units) {
  const float shift = 3 << 22;
  return (lanes_int)lanes_line(x, (float)units, shift) - (lanes_int)lanes_set(shift);
}

/* Rounds the four weights of a row of voxels to integers. The function rounds the running sums of the
 * weights, and not each weight. So the error of a row of voxels is at most half a unit times the differences
 * between neighbours, and rows of equal voxels have no error. total: the sum of all four weights. */
LANES_INLINE integer_weights round_weights(const lanes weight[4], int units, int total) {
  lanes_int first = round_to_units(weight[0], units), two = round_to_units(weight[0] + weight[1], units);
  lanes_int last = round_to_units(weight[3], units);
  return (integer_weights){{first, two - first, total * units - last - two, last}};
}

/* Rounds weights to integers, and converts the integers back to floats. */
LANES_INLINE void round_to_weights(lanes weight[4]) {
  integer_weights integers = round_weights(weight, WEIGHT_UNITS, 1);
  for (int tap = 0; tap < 4; tap++) weight[tap] = lanes_from_int(integers.tap[tap]) * WEIGHT_INVERSE;
}

/* ---- u8 voxels ---- */

/* The functions below weight and add four u8 taps, which are packed in a 32-bit word. The weights are split
 * into parts of a size that the processor's instructions can multiply. */
#if defined(__AVX512VBMI__) && defined(__AVX512VBMI2__) && defined(__AVX512VNNI__)
#define HL_PERMUTES_BYTES 1

/* A lane has four weights or slopes. Each of these numbers is two bytes: digit[0] holds the higher bytes of
 * the lane's four numbers, and digit[1] the lower bytes. The processor multiplies unsigned bytes by signed
 * bytes. Weights are unsigned, and are multiplied by voxels reduced by 128, which are signed. Slopes are
 * signed, and are multiplied by unsigned voxels. */
typedef struct byte_weights {
  __m512i digit[2];
} byte_weights;
typedef struct byte_slopes {
  __m512i digit[2];
} byte_slopes;

/* lower_bytes() and higher_bytes() collect the lower or the higher bytes of four 16-bit numbers in each lane,
 * in order. even: numbers 0 and 2. odd: numbers 1 and 3. */
LANES_INLINE __m512i lower_bytes(__m512i even, __m512i odd) {
  return _mm512_ternarylogic_epi32(_mm512_set1_epi32(0x00ff00ff), even, _mm512_slli_epi32(odd, 8),
                                   0xca); /* the operation a ? b : c for each bit */
}
LANES_INLINE __m512i higher_bytes(__m512i even, __m512i odd) {
  return _mm512_ternarylogic_epi32(_mm512_set1_epi32(0x00ff00ff), _mm512_srli_epi32(even, 8), odd, 0xca);
}
LANES_INLINE __m512i two_words(lanes_int first, lanes_int second) {
  return _mm512_mask_blend_epi16(0xaaaaaaaa, (__m512i)first, _mm512_slli_epi32((__m512i)second, 16));
}

LANES_INLINE byte_weights split_weights(const integer_weights *integers) {
  __m512i even = two_words(integers->tap[0], integers->tap[2]),
          odd = two_words(integers->tap[1], integers->tap[3]);
  return (byte_weights){{higher_bytes(even, odd), lower_bytes(even, odd)}};
}

/* Splits slopes into bytes. A slope is d0 * 256 + d1, where d0 and d1 are signed bytes. If d1 is negative, d0
 * is 1 more than the slope's higher byte. */
LANES_INLINE byte_slopes split_slopes(const integer_weights *integers) {
  const __m512i sign = _mm512_set1_epi16((short)0x8080);
  __m512i even = _mm512_add_epi16(two_words(integers->tap[0], integers->tap[2]), sign);
  __m512i odd = _mm512_add_epi16(two_words(integers->tap[1], integers->tap[3]), sign);
  return (byte_slopes){
      {_mm512_xor_si512(higher_bytes(even, odd), sign), _mm512_xor_si512(lower_bytes(even, odd), sign)}};
}

/* Subtracts 128 from unsigned voxels, or adds 128 to such reduced voxels, by flipping the sign bits. */
LANES_INLINE lanes_int taps_with_sign(lanes_int taps) { return taps ^ (int32_t)0x80808080; }

LANES_INLINE lanes_int weigh_signed_bytes(lanes_int less_128, const byte_weights *weights) {
  /* after a shift to the left by a byte, WEIGHT_UNITS / 2 is 128 times the sum of all weights */
  const __m512i half = _mm512_set1_epi32(WEIGHT_UNITS / 2);
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
/* The weights of taps 0 and 2 share a word, and so do the weights of taps 1 and 3. One instruction multiplies
 * pairs of signed 16-bit numbers and adds the two products. */
typedef struct byte_weights {
  lanes_int pair[2];
} byte_weights;
typedef byte_weights byte_slopes;

LANES_INLINE byte_weights split_weights(const integer_weights *integers) {
  byte_weights weights;
  for (int i = 0; i < 2; i++) weights.pair[i] = (integers->tap[i] & 65535) | integers->tap[i + 2] << 16;
  return weights;
}
LANES_INLINE byte_slopes split_slopes(const integer_weights *integers) { return split_weights(integers); }

LANES_INLINE lanes_int weigh_bytes(lanes_int taps, const byte_weights *weights) {
  return lanes_multiply_shorts(taps & 0x00ff00ff, weights->pair[0]) +
         lanes_multiply_shorts((taps >> 8) & 0x00ff00ff, weights->pair[1]);
}
LANES_INLINE lanes_int slope_of_bytes(lanes_int taps, const byte_slopes *slopes) {
  return weigh_bytes(taps, slopes);
}
#else
typedef integer_weights byte_weights, byte_slopes;

LANES_INLINE byte_weights split_weights(const integer_weights *integers) { return *integers; }
LANES_INLINE byte_slopes split_slopes(const integer_weights *integers) { return *integers; }

LANES_INLINE lanes_int weigh_bytes(lanes_int taps, const byte_weights *weights) {
  return ((taps & 255) * weights->tap[0] + ((taps >> 8) & 255) * weights->tap[1]) +
         (((taps >> 16) & 255) * weights->tap[2] + ((taps >> 24) & 255) * weights->tap[3]);
}
LANES_INLINE lanes_int slope_of_bytes(lanes_int taps, const byte_slopes *slopes) {
  return weigh_bytes(taps, slopes);
}
#endif

/* ---- u16 voxels ---- */

/* The functions below weight and add four u16 taps, which are packed in two 32-bit words. */
#if defined(__AVX2__)
/* The weights of taps 0 and 1 share a word, and so do the weights of taps 2 and 3. One instruction multiplies
 * pairs of signed 16-bit numbers and adds the two products. Because the instruction's numbers are signed,
 * 32768 is subtracted from the voxels. */
typedef struct short_weights {
  lanes_int pair[2];
} short_weights;
typedef short_weights short_slopes;
enum { VOXEL_SIGN = (int32_t)0x80008000u, LESS_BY = 32768 * WEIGHT_UNITS };

LANES_INLINE short_weights pair_weights(const integer_weights *integers) {
  short_weights weights;
  for (int i = 0; i < 2; i++)
    weights.pair[i] = (integers->tap[2 * i] & 65535) | integers->tap[2 * i + 1] << 16;
  return weights;
}
LANES_INLINE short_slopes pair_slopes(const integer_weights *integers) { return pair_weights(integers); }

/* The sum of a lane's four voxels, each multiplied by its slope. The voxels must have been reduced by 32768.
 * The four slopes add up to 0, so the sum equals the sum over the original voxels. */
LANES_INLINE lanes_int slope_of_signed(lanes_int low, lanes_int high, const short_slopes *slopes) {
  return lanes_multiply_shorts(low, slopes->pair[0]) + lanes_multiply_shorts(high, slopes->pair[1]);
}
LANES_INLINE lanes_int weigh_signed(lanes_int low, lanes_int high, const short_weights *weights) {
  return slope_of_signed(low, high, weights) + LESS_BY;
}

LANES_INLINE lanes_int weigh_shorts(lanes_int low, lanes_int high, const short_weights *weights) {
  return weigh_signed(low ^ VOXEL_SIGN, high ^ VOXEL_SIGN, weights);
}
LANES_INLINE lanes_int slope_of_shorts(lanes_int low, lanes_int high, const short_slopes *slopes) {
  return slope_of_signed(low ^ VOXEL_SIGN, high ^ VOXEL_SIGN, slopes);
}
#else
typedef integer_weights short_weights, short_slopes;

LANES_INLINE short_weights pair_weights(const integer_weights *integers) { return *integers; }
LANES_INLINE short_slopes pair_slopes(const integer_weights *integers) { return *integers; }

LANES_INLINE lanes_int weigh_shorts(lanes_int low, lanes_int high, const short_weights *weights) {
  return ((low & 65535) * weights->tap[0] + ((low >> 16) & 65535) * weights->tap[1]) +
         ((high & 65535) * weights->tap[2] + ((high >> 16) & 65535) * weights->tap[3]);
}
/* The voxels are reduced by 32768, so that all sums fit 32 bits. The reduction does not change the result,
 * because the four slopes add up to 0. */
LANES_INLINE lanes_int slope_of_shorts(lanes_int low, lanes_int high, const short_slopes *slopes) {
  return (((low & 65535) - 32768) * slopes->tap[0] + (((low >> 16) & 65535) - 32768) * slopes->tap[1]) +
         (((high & 65535) - 32768) * slopes->tap[2] + (((high >> 16) & 65535) - 32768) * slopes->tap[3]);
}
#endif

/* ---- voxels of any type ---- */

LANES_INLINE lanes weigh_floats(lanes a, lanes b, lanes c, lanes d, const lanes weight[4]) {
  return lanes_fma(a, weight[0], b * weight[1]) + lanes_fma(c, weight[2], d * weight[3]);
}

/* The weights of four taps along each axis, and the weights' derivatives. A tap's weight is the product of
 * three weights. */
typedef struct tap_slope_weights {
  lanes weight[3][4], slope[3][4];
} tap_slope_weights;

/* Weights along x, and slopes along x, in the form that fits the voxels' type: floats for f32 voxels,
 * integers for other voxels. */
typedef struct row_weights {
  lanes real[4];
  byte_weights bytes;
  short_weights shorts;
} row_weights;
typedef struct row_slopes {
  lanes real[4];
  byte_slopes bytes;
  short_slopes shorts;
} row_slopes;

LANES_INLINE int has_integer_weights(hl_storage storage) { return storage != HL_STORAGE_F32; }

LANES_INLINE row_weights weights_of_row(hl_storage storage, const lanes weight[4]) {
  row_weights weights;
  for (int tap = 0; tap < 4; tap++) weights.real[tap] = weight[tap];
  if (!has_integer_weights(storage)) return weights;
  integer_weights integers = round_weights(weight, WEIGHT_UNITS, 1);
  if (storage == HL_STORAGE_U8) weights.bytes = split_weights(&integers);
  else weights.shorts = pair_weights(&integers);
  return weights;
}
LANES_INLINE row_slopes slopes_of_row(hl_storage storage, const lanes slope[4]) {
  row_slopes slopes;
  for (int tap = 0; tap < 4; tap++) slopes.real[tap] = slope[tap];
  if (!has_integer_weights(storage)) return slopes;
  integer_weights integers = round_weights(slope, SLOPE_UNITS, 0);
  if (storage == HL_STORAGE_U8) slopes.bytes = split_slopes(&integers);
  else slopes.shorts = pair_slopes(&integers);
  return slopes;
}

/* The weighted sum of four neighbouring voxels along x, for every lane. offsets: number of bytes from `row`
 * to each lane's first voxel. With integer weights, the sum is in units of the weights. */
LANES_INLINE lanes row_f32(const unsigned char *row, const lanes_offsets *offsets, const lanes weight[4]) {
  return weigh_floats((lanes)lanes_load_words(row, offsets), (lanes)lanes_load_words(row + 4, offsets),
                      (lanes)lanes_load_words(row + 8, offsets), (lanes)lanes_load_words(row + 12, offsets),
                      weight);
}
LANES_INLINE lanes sum_row(hl_storage storage, const unsigned char *row, const lanes_offsets *offsets,
                           const row_weights *weights) {
  if (storage == HL_STORAGE_F32) return row_f32(row, offsets, weights->real);
  if (storage == HL_STORAGE_U8)
    return lanes_from_int(weigh_bytes(lanes_load_words(row, offsets), &weights->bytes));
  return lanes_from_int(
      weigh_shorts(lanes_load_words(row, offsets), lanes_load_words(row + 4, offsets), &weights->shorts));
}
/* The sum of four neighbouring voxels along x, weighted by slopes, in units of slopes. */
LANES_INLINE lanes slope_row(hl_storage storage, const unsigned char *row, const lanes_offsets *offsets,
                             const row_slopes *slopes) {
  if (storage == HL_STORAGE_F32) return row_f32(row, offsets, slopes->real);
  if (storage == HL_STORAGE_U8)
    return lanes_from_int(slope_of_bytes(lanes_load_words(row, offsets), &slopes->bytes));
  return lanes_from_int(
      slope_of_shorts(lanes_load_words(row, offsets), lanes_load_words(row + 4, offsets), &slopes->shorts));
}

/* Converts sums in units of the integer weights, or of the integer slopes, to stored units. */
LANES_INLINE lanes from_units(hl_storage storage, lanes sum) {
  return has_integer_weights(storage) ? sum * WEIGHT_INVERSE : sum;
}
LANES_INLINE lanes from_slope_units(hl_storage storage, lanes sum) {
  return has_integer_weights(storage) ? sum * SLOPE_INVERSE : sum;
}

#endif
