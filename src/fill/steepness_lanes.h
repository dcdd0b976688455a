/* fill/steepness_lanes.h - computes the factor by which a volume's extinction is multiplied. The factor
 * follows from the length of the volume's gradient, from the volume's mask, and from the second number of its
 * transfer function. */
#ifndef HL_FILL_STEEPNESS_LANES_H
#define HL_FILL_STEEPNESS_LANES_H

#include "fill/gradient_lanes.h"
#include "fill/mask_lanes.h"
#include "fill/plane_lanes.h"
#include "simd/gathers.h"

/* The gradient at a point of frame space, in stored units per frame unit. Derived: df/dframe =
 * (dindex/dframe)^T df/dindex. m: maps frame space to index space. */
LANES_INLINE lanes3 gradient_in_frame(const grid *grid, const kernel *kernel, const float m[3][4],
                                      lanes3 point, uint32_t active, uint32_t starts) {
  lanes3 at = {row_of_point(m[0], point), row_of_point(m[1], point), row_of_point(m[2], point)};
  lanes3 slope = slopes_at(grid, kernel, at, active, starts);
  return add_scaled3(add_scaled3(scale3(set3(m[2]), slope.z), set3(m[1]), slope.y), set3(m[0]), slope.x);
}

/* The factor by which gradient opacity multiplies extinction if the gradient is `slope` (stored units per
 * frame unit). The classifier must have gradient opacity. */
LANES_INLINE lanes factor_of_slope(const classifier *classifier, lanes3 slope) {
  lanes3 scaled = scale3(slope, lanes_set(classifier->steepness_scale));
  lanes x = lanes_clamp(lanes_sqrt(dot3(scaled, scaled)), 0, STEEPNESS_ENTRIES), a, b;
  lanes_int entry = lanes_truncate(x);
  lanes_gather_pairs(classifier->steepness, entry, &a, &b);
  return lanes_fma(b - a, x - lanes_from_int(entry), a);
}

/* The matter of one volume on sixteen ways of rays through a slab. */
typedef struct matter_way {
  const grid *grid;
  const kernel *kernel;
  const classifier *classifier;
  const float (*to_index)[4]; /* maps frame space to index space */
  /* the point, in frame space, at which the matter would be seen if its extinction depended on the value
   * alone */
  lanes3 point;
  lanes from, to;          /* coordinates in the classifier's tables: the values where each way begins
                            * and ends */
  lanes extinction;        /* the mean extinction on the way, without the factor */
  uint32_t active, starts; /* one bit for each lane; active: the lanes with extinction, at least one lane;
                            * starts: the first lane of each block of pixels */
  int wants_slope;         /* not 0 if the caller reads the slope, even if the factor does not depend on the
                            * slope */
} matter_way;

/* The factor by which a volume's extinction is multiplied. */
typedef struct matter_factor {
  lanes factor;
  lanes3 slope; /* the gradient at the point, in stored units per frame unit; 0 if neither the factor nor the
                 * caller needs the gradient */
  lanes row;    /* the row of the second number in the table of a function of two numbers */
} matter_factor;

/* The factor for the matter on sixteen ways. This large function is not inlined, so that loops that do not
 * call it stay small. */
static __attribute__((noinline)) matter_factor factor_of_matter(const matter_way *way) {
  const classifier *classifier = way->classifier;
  const plane_table *plane = &classifier->plane;
  matter_factor found = {lanes_set(1.0f), {lanes_set(0), lanes_set(0), lanes_set(0)}, lanes_set(0)};
  /* if the function does not depend on the second number, every row gives the same result */
  int varies = plane->sums != NULL &&
               (lanes_bits(depends_on_row(plane, way->from, way->to)) & way->active) != 0;
  int needs_slope = classifier->steepness != NULL || (varies && plane->axis == HL_SECOND_GRADIENT);
  if (needs_slope || (way->wants_slope && hl_classifier_needs_gradient(classifier)))
    found.slope = gradient_in_frame(way->grid, way->kernel, way->to_index, way->point, way->active,
                                    way->starts);
  if (classifier->steepness != NULL) found.factor = factor_of_slope(classifier, found.slope);
  if (classifier->mask.factors != NULL)
    found.factor = found.factor * mask_factor(&classifier->mask, way->point, way->active);
  if (plane->sums == NULL) return found;
  if (varies)
    found.row = row_of_matter(plane, way->kernel, found.slope, way->point, way->active, way->starts);
  lanes extinction = extinction_in_row(plane, found.row, way->from, way->to);
  found.factor = found.factor * (extinction / lanes_max(way->extinction, lanes_set(1e-30f)));
  return found;
}

#endif
