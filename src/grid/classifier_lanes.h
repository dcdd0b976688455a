/* grid/classifier_lanes.h - classifies the densities of sixteen rays between one sheet and the next. */
#ifndef HL_GRID_CLASSIFIER_LANES_H
#define HL_GRID_CLASSIFIER_LANES_H

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

/* Where a and b are closer than this many entries, the difference of integrals loses digits, and the mean of
 * the two ends is as accurate. */
static const float CLOSE_ENTRIES = 4;

/* Integrals I from coordinate a to coordinate b of a table. */
typedef struct way_sums {
  lanes extinction; /* the mean, (I(b) - I(a)) / (b - a) */
  lanes integral;   /* I(b) - I(a), 0 where the ends are close */
  lanes moment;     /* the integral of extinction * entry, 0 where the ends are close */
} way_sums;

LANES_INLINE way_sums sums_of_way(const classifier *classifier, table_coordinate a, table_coordinate b) {
  lanes at_a[3], at_b[3];
  table_values(classifier->sums, a, at_a);
  table_values(classifier->sums, b, at_b);
  lanes ends = (at_a[0] + at_b[0]) * 0.5f, distance = b.x - a.x;
  lanes_int far = lanes_abs(distance) > CLOSE_ENTRIES;
  way_sums sums = {ends, lanes_keep(far, at_b[1] - at_a[1]), at_b[2] - at_a[2]};
  lanes mean = lanes_max(sums.integral / lanes_select(far, distance, lanes_set(1.0f)), lanes_set(0));
  sums.extinction = lanes_select(far, mean, ends);
  return sums;
}

/* Lanes in which some density between a and b can have extinction. */
LANES_INLINE lanes_int may_be_visible(const classifier *classifier, table_coordinate a, table_coordinate b) {
  return (lanes_max(a.x, b.x) > classifier->first_visible) & (lanes_min(a.x, b.x) < classifier->last_visible);
}

/* The density's mean distance from a and from b, between the two, weighted by extinction, in entries; 1 and 1
 * where a and b are close or nothing between them has extinction. */
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
