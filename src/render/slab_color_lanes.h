/* render/slab_color_lanes.h - finds the transfer function's colour of a volume's matter in a slab, at sixteen
 * samples (step 13).
 *
 * A slab that spans several colours shows their mean. Derived: a place in a slab with the optical depth e has
 * the weight e exp(-e s) / (1 - exp(-e)), where s is the part of e that lies before this place. The mean of s
 * with this weight is u = seen_part(e), which is 1/2 in thin slabs and 1 / e in opaque ones. Equal weights
 * over the first part of the slab, up to 2 u of the depth, have the same mean and leave out hidden matter.
 * The depth is proportional to the integral of extinction over density. So the mean colour is (K(f2) - K(f1))
 * / (T(f2) - T(f1)). T is the integral of extinction, and K the integral of extinction times colour. f1 is
 * the density where the slab begins, f2 the density where the part 2 u of its depth is passed. As f2
 * approaches f1, the mean colour approaches the colour of f1. */
#ifndef HL_RENDER_SLAB_COLOR_LANES_H
#define HL_RENDER_SLAB_COLOR_LANES_H

#include "core/sheet_constants.h"
#include "render/light_depth_lanes.h"

/* Looks up the integrals K (red, green, blue) and T, in this order, at a coordinate of the tables. */
LANES_INLINE void shown_below(const classifier *classifier, lanes x, lanes sums[4]) {
  table_coordinate at = split_coordinate(x);
  lanes a[4], b[4];
  lanes_gather_quads(&classifier->shown[0][0], at.entry * 4, a);
  lanes_gather_quads(&classifier->shown[1][0], at.entry * 4, b);
  for (int i = 0; i < 4; i++) sums[i] = lanes_fma(b[i] - a[i], at.fraction, a[i]);
}

/* The lanes in which the slope of the colour changes somewhere between the slab's ends. */
LANES_INLINE lanes_int is_color_bent(const classifier *classifier, const block_density *d) {
  lanes bent = lanes_gather(classifier->bent, lanes_truncate(d->after)) -
               lanes_gather(classifier->bent, lanes_truncate(d->before));
  return lanes_abs(bent * (d->after - d->before)) > CLASSIFIER_LEAST_BENDING;
}

/* Finds the visible part of a way's optical depth, as coordinates in the tables. Returns the coordinate of
 * its end, and sets *from to the coordinate of its beginning. If matter is seen from the other side,
 * d->evenly is 1 - u, and the visible part is the last 2 u of the depth. */
LANES_INLINE lanes end_of_shown(const block_density *d, lanes *from) {
  way_means m = means_of_way(d->before, d->after, &d->sums);
  lanes_int front = d->evenly <= 0.5f;
  lanes part = lanes_clamp(
      lanes_fma(d->evenly, lanes_set(2.0f), lanes_select(front, lanes_set(0), lanes_set(-1.0f))), 0, 1);
  *from = lanes_select(front, d->before, d->after);
  return lanes_fma(d->after - d->before, way_of_depth(m.from_a, m.from_b, part), d->before);
}

/* The mean colour of the visible part of a volume's matter, linear RGB; set in the active lanes. */
LANES_INLINE void color_of_way(const classifier *classifier, const block_density *d, uint32_t active,
                               lanes color[3]) {
  table_values(classifier->color, split_coordinate(coordinate_seen(d)), color);
  if (classifier->bent == NULL) return;
  lanes_int bent = is_color_bent(classifier, d);
  if ((lanes_bits(bent) & active) == 0) return;
  lanes from, at_from[4], at_to[4], to = end_of_shown(d, &from);
  shown_below(classifier, from, at_from);
  shown_below(classifier, to, at_to);
  lanes shown = at_to[3] - at_from[3];
  lanes_int usable = bent & (lanes_abs(shown) > at_to[3] * LEAST_PART_OF_SHOWN);
  lanes inverse = 1.0f / lanes_select(usable, shown, lanes_set(1.0f));
  for (int c = 0; c < 3; c++) {
    lanes mean = lanes_max((at_to[c] - at_from[c]) * inverse, lanes_set(0));
    color[c] = lanes_select(usable, mean, color[c]);
  }
}

#endif
