/* grid/classifier_lanes.h - classifies the densities of sixteen rays between one sheet and the next. */
#ifndef HL_GRID_CLASSIFIER_LANES_H
#define HL_GRID_CLASSIFIER_LANES_H

#include "core/sheet_constants.h"
#include "grid/classifier.h"
#include "simd/gathers.h"

/* A coordinate in the classifier's tables: x = entry + fraction. */
typedef struct table_coordinate {
  lanes x;
  lanes_int entry;
  lanes fraction;
} table_coordinate;

LANES_INLINE table_coordinate split_coordinate(lanes x) {
  lanes_int entry = lanes_truncate(x);
  return (table_coordinate){x, entry, x - lanes_from_int(entry)};
}

LANES_INLINE table_coordinate coordinate_of_density(const classifier *classifier, lanes density) {
  return split_coordinate(
      lanes_clamp(lanes_line(density, classifier->scale, classifier->offset), 0, CLASSIFIER_ENTRIES));
}

/* The values of a table's first three columns at a coordinate. */
LANES_INLINE void table_values(float (*table)[4], table_coordinate at, lanes values[3]) {
  lanes a[3], b[3];
  lanes_gather_row_pairs(&table[0][0], at.entry, a, b);
  for (int i = 0; i < 3; i++) values[i] = lanes_fma(b[i] - a[i], at.fraction, a[i]);
}

/* Integrals of the classifier's tables over the entries from coordinate a to coordinate b. I is the integral
 * of extinction. */
typedef struct way_sums {
  lanes extinction; /* the mean extinction, (I(b) - I(a)) / (b - a) */
  lanes integral;   /* the integral of extinction from coordinate a to coordinate b, I(b) - I(a); 0 in lanes
                     * whose a and b are close together */
  lanes moment;     /* the integral, from a to b, of extinction times the entry's number */
} way_sums;

/* The integrals of extinction over entries, from entry 0 to each of the two ends of a way. */
typedef struct way_ends {
  lanes to_a, to_b;
} way_ends;

LANES_INLINE way_sums sums_and_ends_of_way(const classifier *classifier, table_coordinate a,
                                           table_coordinate b, way_ends *to) {
  lanes at_a[3], at_b[3];
  table_values(classifier->sums, a, at_a);
  table_values(classifier->sums, b, at_b);
  lanes ends = (at_a[0] + at_b[0]) * 0.5f, distance = b.x - a.x;
  lanes_int far = lanes_abs(distance) > CLOSE_ENTRIES;
  way_sums sums = {ends, lanes_keep(far, at_b[1] - at_a[1]), at_b[2] - at_a[2]};
  *to = (way_ends){at_a[1], at_b[1]};
  lanes mean = lanes_max(sums.integral / lanes_select(far, distance, lanes_set(1.0f)), lanes_set(0));
  sums.extinction = lanes_select(far, mean, ends);
  return sums;
}

LANES_INLINE way_sums sums_of_way(const classifier *classifier, table_coordinate a, table_coordinate b) {
  way_ends to;
  return sums_and_ends_of_way(classifier, a, b, &to);
}

/* The lanes in which some density between a and b can have extinction. */
LANES_INLINE lanes_int may_be_visible(const classifier *classifier, table_coordinate a, table_coordinate b) {
  return (lanes_max(a.x, b.x) > classifier->first_visible) & (lanes_min(a.x, b.x) < classifier->last_visible);
}

/* The integral of extinction over table entries from 0 to x. x is a coordinate of the tables, which counts
 * entries. */
LANES_INLINE lanes integral_to(const classifier *classifier, lanes x) {
  lanes values[3];
  table_values(classifier->sums, split_coordinate(x), values);
  return values[1];
}

typedef struct second_surface {
  lanes kept;  /* the fraction of the light absorbed by the first surface that counts as absorbed by the
                * second surface */
  lanes ahead; /* the optical depth on the light's way from the place where the light is known to the
                * beginning of the second surface */
} second_surface;

/* Finds how a first surface on the light's way affects a second surface behind it. first, foot: the values at
 * which the first and the second surface begin. start: the value at the place where the light is known.
 * light, outside: the light at this place, and the light at the outside of the first surface. rise: the
 * change of values per unit of the light's way, above 0. Derived: a straight ramp from the value a to the
 * value b has the optical depth |P(b) - P(a)| / rise, where P is the integral of extinction. */
LANES_INLINE second_surface kept_at_foot(const classifier *classifier, lanes first, lanes start, lanes foot,
                                         lanes rise, lanes light, lanes outside) {
  lanes at_foot = integral_to(classifier, foot), ramp = lanes_abs(at_foot - integral_to(classifier, first)),
        ahead = lanes_abs(at_foot - integral_to(classifier, start));
  lanes taken = lanes_log2(lanes_max(outside, lanes_set(1e-9f)) / lanes_max(light, lanes_set(1e-9f))) *
                0.6931472f;
  lanes ratio = lanes_fma(lanes_max(taken, lanes_set(0)), rise, ahead) / lanes_max(ramp, lanes_set(1e-9f));
  return (second_surface){lanes_clamp((OTHER_LAYER - ratio) * (1.0f / (OTHER_LAYER - SAME_RAMP)), 0, 1),
                          ahead / lanes_max(rise, lanes_set(1e-9f))};
}

/* A bound of the optical depth of a surface's own matter before a sheet. integral: of extinction, over the
 * values from the surface's beginning to the value at the sheet. rise: the change of values per unit of
 * length behind the sheet. Derived: a straight ramp has the depth integral / rise. If values rise as s^p over
 * the distance s, and extinction as the value to the power q, the depth is p (q + 1) / (p q + 1) times as
 * great, which is less than 2 if q is 1 or more. */
LANES_INLINE lanes greatest_depth_of_surface(lanes integral, lanes rise) {
  return 2.0f * integral / lanes_max(rise, lanes_set(1e-9f));
}

/* Some light is missing at a place. Matter before the place can have absorbed at most the returned fraction
 * of the missing light. depth: the optical depth of this matter. light, outside: the light at the place, and
 * the light at the outside of surfaces; their difference is missing. beside: the most light that a pixel
 * around the place has; where it is more than `light`, the matter may have absorbed the difference. Derived:
 * if the light T is left behind matter of the depth d, T e^d came to the matter, which has absorbed T (e^d -
 * 1). */
LANES_INLINE lanes part_of_matter(lanes depth, lanes light, lanes outside, lanes beside) {
  lanes left = lanes_exp_negative(lanes_min(depth, lanes_set(20.0f))),
        absorbed = lanes_max(lanes_max(light, lanes_set(0)) * (1.0f - left), (beside - light) * left),
        missing = (outside - light) * left;
  return lanes_select(absorbed < missing, absorbed / missing, lanes_set(1.0f));
}

/* The mean distances, in entries of the table, from the two ends a and b of a way to the densities on the
 * way. Densities are weighted by their extinction. Both distances are 1 if a and b are close, or if nothing
 * between them has extinction. */
typedef struct way_means {
  lanes from_a, from_b;
} way_means;

LANES_INLINE way_means means_of_way(lanes a, lanes b, const way_sums *sums) {
  lanes_int usable = lanes_abs(sums->integral) > 0.0f;
  lanes mean = sums->moment / lanes_select(usable, sums->integral, lanes_set(1.0f));
  mean = lanes_min(lanes_max(mean, lanes_min(a, b)), lanes_max(a, b));
  return (way_means){lanes_select(usable, lanes_abs(mean - a), lanes_set(1.0f)),
                     lanes_select(usable, lanes_abs(mean - b), lanes_set(1.0f))};
}

#endif
