/* splat/row_lanes.h - four neighbouring voxels along x, weighed and added. */
#ifndef HL_SPLAT_ROW_LANES_H
#define HL_SPLAT_ROW_LANES_H

#include "splat/byte_weights_lanes.h"
#include "splat/grid.h"

LANES_INLINE lanes weigh_floats(lanes a, lanes b, lanes c, lanes d, const lanes weight[4]) {
  return lanes_fma(a, weight[0], b * weight[1]) + lanes_fma(c, weight[2], d * weight[3]);
}

/* Two u16 taps a word. */
LANES_INLINE lanes weigh_words(lanes_int low, lanes_int high, const lanes weight[4]) {
  return weigh_floats(lanes_from_int(low & 65535), lanes_from_int((low >> 16) & 65535), lanes_from_int(high & 65535),
                      lanes_from_int((high >> 16) & 65535), weight);
}
LANES_INLINE lanes row_u16(const unsigned char *row, const lanes_offsets *offsets, const lanes weight[4]) {
  return weigh_words(lanes_load_words(row, offsets), lanes_load_words(row + 4, offsets), weight);
}
LANES_INLINE lanes row_f32(const unsigned char *row, const lanes_offsets *offsets, const lanes weight[4]) {
  return weigh_floats((lanes)lanes_load_words(row, offsets), (lanes)lanes_load_words(row + 4, offsets),
                      (lanes)lanes_load_words(row + 8, offsets), (lanes)lanes_load_words(row + 12, offsets), weight);
}

/* Weights along x and their slopes in either form: whole numbers for u8. */
typedef struct row_weights { lanes real[4]; byte_weights bytes; } row_weights;
typedef struct row_slopes { lanes real[4]; byte_slopes bytes; } row_slopes;

LANES_INLINE row_weights weights_of_row(hl_storage storage, const lanes weight[4]) {
  row_weights weights;
  for (int tap = 0; tap < 4; tap++) weights.real[tap] = weight[tap];
  if (storage != HL_STORAGE_U8) return weights;
  whole_weights whole = round_weights(weight, WEIGHT_UNITS, 1);
  weights.bytes = split_weights(&whole);
  return weights;
}
LANES_INLINE row_slopes slopes_of_row(hl_storage storage, const lanes slope[4]) {
  row_slopes slopes;
  for (int tap = 0; tap < 4; tap++) slopes.real[tap] = slope[tap];
  if (storage != HL_STORAGE_U8) return slopes;
  whole_weights whole = round_weights(slope, SLOPE_UNITS, 0);
  slopes.bytes = split_slopes(&whole);
  return slopes;
}

LANES_INLINE lanes real_row(hl_storage storage, const unsigned char *row, const lanes_offsets *offsets, const lanes weight[4]) {
  return storage == HL_STORAGE_U16 ? row_u16(row, offsets, weight) : row_f32(row, offsets, weight);
}

/* Four neighbouring voxels along x for every lane, weighed and added; offsets in bytes. u8 in units of weights. */
LANES_INLINE lanes sum_row(hl_storage storage, const unsigned char *row, const lanes_offsets *offsets, const row_weights *weights) {
  if (storage != HL_STORAGE_U8) return real_row(storage, row, offsets, weights->real);
  return lanes_from_int(weigh_bytes(lanes_load_words(row, offsets), &weights->bytes));
}
/* The same by slopes, and in their units. */
LANES_INLINE lanes slope_row(hl_storage storage, const unsigned char *row, const lanes_offsets *offsets, const row_slopes *slopes) {
  if (storage != HL_STORAGE_U8) return real_row(storage, row, offsets, slopes->real);
  return lanes_from_int(slope_of_bytes(lanes_load_words(row, offsets), &slopes->bytes));
}

#endif
