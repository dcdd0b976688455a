/* splat/row_lanes.h - four neighbouring voxels along x, weighed and added. */
#ifndef HL_SPLAT_ROW_LANES_H
#define HL_SPLAT_ROW_LANES_H

#include "simd/lanes.h"
#include "splat/grid.h"

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

/* Four u8 taps a word, weighed and added. */
#if defined(__AVX2__)
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

/* Four neighbouring voxels along x for every lane, weighed and added; offsets in bytes. u8 in WHOLE_UNITs. */
LANES_INLINE lanes row_u8(const unsigned char *row, const lanes_offsets *offsets, const byte_weights *weights) {
  return lanes_from_int(weigh_bytes(lanes_load_words(row, offsets), weights));
}

/* Two u16 taps a word. */
LANES_INLINE lanes weigh_words(lanes_int low, lanes_int high, const lanes weight[4]) {
  lanes a = lanes_from_int(low & 65535) * weight[0] + lanes_from_int((low >> 16) & 65535) * weight[1];
  lanes b = lanes_from_int(high & 65535) * weight[2] + lanes_from_int((high >> 16) & 65535) * weight[3];
  return a + b;
}
LANES_INLINE lanes row_u16(const unsigned char *row, const lanes_offsets *offsets, const lanes weight[4]) {
  return weigh_words(lanes_load_words(row, offsets), lanes_load_words(row + 4, offsets), weight);
}
LANES_INLINE lanes weigh_floats(lanes a, lanes b, lanes c, lanes d, const lanes weight[4]) {
  return (a * weight[0] + b * weight[1]) + (c * weight[2] + d * weight[3]);
}
LANES_INLINE lanes row_f32(const unsigned char *row, const lanes_offsets *offsets, const lanes weight[4]) {
  return weigh_floats((lanes)lanes_load_words(row, offsets), (lanes)lanes_load_words(row + 4, offsets),
                      (lanes)lanes_load_words(row + 8, offsets), (lanes)lanes_load_words(row + 12, offsets), weight);
}

/* Weights along x in either form: whole numbers for u8. */
typedef struct row_weights { lanes real[4]; byte_weights bytes; } row_weights;

LANES_INLINE lanes sum_row(hl_storage storage, const unsigned char *row, const lanes_offsets *offsets, const row_weights *weights) {
  return storage == HL_STORAGE_U8    ? row_u8(row, offsets, &weights->bytes)
         : storage == HL_STORAGE_U16 ? row_u16(row, offsets, weights->real)
                                     : row_f32(row, offsets, weights->real);
}

LANES_INLINE row_weights weights_of_row(hl_storage storage, const lanes weight[4], int total) {
  row_weights weights;
  for (int tap = 0; tap < 4; tap++) weights.real[tap] = weight[tap];
  if (storage != HL_STORAGE_U8) return weights;
  whole_weights whole = round_weights(weight, total);
  weights.bytes = split_weights(&whole);
  return weights;
}

#endif
