/* splat/short_weights_lanes.h - weighing u16 voxels along x. */
#ifndef HL_SPLAT_SHORT_WEIGHTS_LANES_H
#define HL_SPLAT_SHORT_WEIGHTS_LANES_H

#include "splat/whole_weights_lanes.h"

/* Two u16 taps a word, four a lane, weighed and added. */
#if defined(__AVX2__)
/* Those of the taps 0 and 1 share a word, and those of 2 and 3: one instruction multiplies signed numbers of
 * 16 bits and adds the two products. Voxels are less 32768 for it, as numbers with a sign. */
typedef struct short_weights {
  lanes_int pair[2];
} short_weights;
typedef short_weights short_slopes;
enum { VOXEL_SIGN = (int32_t)0x80008000u, LESS_BY = 32768 * WEIGHT_UNITS };

LANES_INLINE short_weights pair_weights(const whole_weights *whole) {
  short_weights weights;
  for (int i = 0; i < 2; i++) weights.pair[i] = (whole->tap[2 * i] & 65535) | whole->tap[2 * i + 1] << 16;
  return weights;
}
LANES_INLINE short_slopes pair_slopes(const whole_weights *whole) { return pair_weights(whole); }

/* Of voxels less 32768. Slopes add up to nothing, and what voxels are less by with them. */
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
typedef whole_weights short_weights, short_slopes;

LANES_INLINE short_weights pair_weights(const whole_weights *whole) { return *whole; }
LANES_INLINE short_slopes pair_slopes(const whole_weights *whole) { return *whole; }

LANES_INLINE lanes_int weigh_shorts(lanes_int low, lanes_int high, const short_weights *weights) {
  return ((low & 65535) * weights->tap[0] + ((low >> 16) & 65535) * weights->tap[1]) +
         ((high & 65535) * weights->tap[2] + ((high >> 16) & 65535) * weights->tap[3]);
}
/* Less 32768, so that all of the sums fit 32 bits. */
LANES_INLINE lanes_int slope_of_shorts(lanes_int low, lanes_int high, const short_slopes *slopes) {
  return (((low & 65535) - 32768) * slopes->tap[0] + (((low >> 16) & 65535) - 32768) * slopes->tap[1]) +
         (((high & 65535) - 32768) * slopes->tap[2] + (((high >> 16) & 65535) - 32768) * slopes->tap[3]);
}
#endif

#endif
