/* fill/steepness_lanes.h - what the length of a volume's gradient, and its mask, make of its extinction. */
#ifndef HL_FILL_STEEPNESS_LANES_H
#define HL_FILL_STEEPNESS_LANES_H

#include "fill/gradient_lanes.h"
#include "fill/mask_lanes.h"

/* The gradient at a point of frame space: df/dframe = (dindex/dframe)^T df/dindex; stored units per frame
 * unit. m: frame space to index space. */
LANES_INLINE lanes3 gradient_in_frame(const grid *grid, const kernel *kernel, const float m[3][4],
                                      lanes3 point, uint32_t active, uint32_t starts) {
  lanes3 at = {row_of_point(m[0], point), row_of_point(m[1], point), row_of_point(m[2], point)};
  lanes3 slope = slopes_at(grid, kernel, at, active, starts);
  return add_scaled3(add_scaled3(scale3(set3(m[2]), slope.z), set3(m[1]), slope.y), set3(m[0]), slope.x);
}

/* What extinction is multiplied by where the gradient is `slope` (stored units per frame unit). The
 * classifier has gradient opacity. */
LANES_INLINE lanes factor_of_slope(const classifier *classifier, lanes3 slope) {
  lanes3 scaled = scale3(slope, lanes_set(classifier->steepness_scale));
  lanes x = lanes_clamp(lanes_sqrt(dot3(scaled, scaled)), 0, STEEPNESS_ENTRIES), a, b;
  lanes_int entry = lanes_truncate(x);
  lanes_gather_pairs(classifier->steepness, entry, &a, &b);
  return lanes_fma(b - a, x - lanes_from_int(entry), a);
}

/* What extinction is multiplied by at a point of frame space. slope: the gradient there; not read without
 * gradient opacity. */
LANES_INLINE lanes factor_of_matter(const classifier *classifier, lanes3 slope, lanes3 point) {
  lanes factor = lanes_set(1.0f);
  if (classifier->steepness != NULL) factor = factor_of_slope(classifier, slope);
  if (classifier->mask.factors != NULL) factor = factor * mask_factor(&classifier->mask, point);
  return factor;
}

#endif
