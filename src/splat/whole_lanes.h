/* splat/whole_lanes.h - weights along x as whole numbers. */
#ifndef HL_SPLAT_WHOLE_LANES_H
#define HL_SPLAT_WHOLE_LANES_H

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

#endif
