/* splat/row_lanes.h - four neighbouring voxels along x, weighed and added. */
#ifndef HL_SPLAT_ROW_LANES_H
#define HL_SPLAT_ROW_LANES_H

#include "splat/byte_weights_lanes.h"
#include "splat/grid.h"
#include "splat/short_weights_lanes.h"

LANES_INLINE lanes weigh_floats(lanes a, lanes b, lanes c, lanes d, const lanes weight[4]) {
  return lanes_fma(a, weight[0], b * weight[1]) + lanes_fma(c, weight[2], d * weight[3]);
}

/* Of the 64 taps, along each axis. */
typedef struct tap_slope_weights {
  lanes weight[3][4], slope[3][4];
} tap_slope_weights;

/* Weights along x and their slopes, in the form that the voxels' type takes: whole numbers but for f32. */
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

LANES_INLINE int weights_are_whole(hl_storage storage) { return storage != HL_STORAGE_F32; }

LANES_INLINE row_weights weights_of_row(hl_storage storage, const lanes weight[4]) {
  row_weights weights;
  for (int tap = 0; tap < 4; tap++) weights.real[tap] = weight[tap];
  if (!weights_are_whole(storage)) return weights;
  whole_weights whole = round_weights(weight, WEIGHT_UNITS, 1);
  if (storage == HL_STORAGE_U8) weights.bytes = split_weights(&whole);
  else weights.shorts = pair_weights(&whole);
  return weights;
}
LANES_INLINE row_slopes slopes_of_row(hl_storage storage, const lanes slope[4]) {
  row_slopes slopes;
  for (int tap = 0; tap < 4; tap++) slopes.real[tap] = slope[tap];
  if (!weights_are_whole(storage)) return slopes;
  whole_weights whole = round_weights(slope, SLOPE_UNITS, 0);
  if (storage == HL_STORAGE_U8) slopes.bytes = split_slopes(&whole);
  else slopes.shorts = pair_slopes(&whole);
  return slopes;
}

/* Four neighbouring voxels along x for every lane, weighed and added; offsets in bytes. In units of weights
 * where those are whole. */
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
/* The same by slopes, and in their units. */
LANES_INLINE lanes slope_row(hl_storage storage, const unsigned char *row, const lanes_offsets *offsets,
                             const row_slopes *slopes) {
  if (storage == HL_STORAGE_F32) return row_f32(row, offsets, slopes->real);
  if (storage == HL_STORAGE_U8)
    return lanes_from_int(slope_of_bytes(lanes_load_words(row, offsets), &slopes->bytes));
  return lanes_from_int(
      slope_of_shorts(lanes_load_words(row, offsets), lanes_load_words(row + 4, offsets), &slopes->shorts));
}

/* Sums in units of weights, in the voxels'. */
LANES_INLINE lanes from_units(hl_storage storage, lanes sum) {
  return weights_are_whole(storage) ? sum * WEIGHT_INVERSE : sum;
}
LANES_INLINE lanes from_slope_units(hl_storage storage, lanes sum) {
  return weights_are_whole(storage) ? sum * SLOPE_INVERSE : sum;
}

#endif
