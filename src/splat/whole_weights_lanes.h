/* splat/whole_weights_lanes.h - weights along x of u8 and u16 voxels, as whole numbers. */
#ifndef HL_SPLAT_WHOLE_WEIGHTS_LANES_H
#define HL_SPLAT_WHOLE_WEIGHTS_LANES_H

#include "simd/lanes.h"

/* Weights along x are whole numbers, so that sums of four taps are exact whatever the instruction set: 255 *
 * 32766 at most of u8 taps, which is a float too, and 65535 * 32766 of u16 ones, which 32 bits hold. A weight
 * is never below 0 and fits 16 bits with a sign. So do slopes, the derivatives of weights: of all kernels'
 * they and their sums stay below 1.08. */
enum { WEIGHT_UNITS = 32766, SLOPE_UNITS = 30000 };
static const float WEIGHT_INVERSE = 1.0f / WEIGHT_UNITS, SLOPE_INVERSE = 1.0f / SLOPE_UNITS;

typedef struct whole_weights {
  lanes_int tap[4];
} whole_weights;

/* x units, rounded to the nearest whole number below 2^22: of a float from 2^23 to 2^24 a unit is the last
 * bit, and adding rounds to it. */
LANES_INLINE lanes_int round_to_units(lanes x, int units) {
  const float whole = 3 << 22;
  return (lanes_int)lanes_line(x, (float)units, whole) - (lanes_int)lanes_set(whole);
}

/* The sums from the first tap on are rounded, not the taps: what a row of voxels is then off by is half a
 * unit of the differences between neighbours, and constant rows are exact. total: of the four. */
LANES_INLINE whole_weights round_weights(const lanes weight[4], int units, int total) {
  lanes_int first = round_to_units(weight[0], units), two = round_to_units(weight[0] + weight[1], units);
  lanes_int last = round_to_units(weight[3], units);
  return (whole_weights){{first, two - first, total * units - last - two, last}};
}

/* The weights that those voxels get, as floats. */
LANES_INLINE void round_to_weights(lanes weight[4]) {
  whole_weights whole = round_weights(weight, WEIGHT_UNITS, 1);
  for (int tap = 0; tap < 4; tap++) weight[tap] = lanes_from_int(whole.tap[tap]) * WEIGHT_INVERSE;
}

#endif
