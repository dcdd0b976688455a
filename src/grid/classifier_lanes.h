/* grid/classifier_lanes.h - classification of the way from one sheet to the next, sixteen rays at a time. */
#ifndef HL_GRID_CLASSIFIER_LANES_H
#define HL_GRID_CLASSIFIER_LANES_H

#include "grid/classifier.h"
#include "simd/lanes.h"

/* A place in the tables: entry + fraction. */
typedef struct table_place {
  lanes x;
  lanes_int entry;
  lanes fraction;
} table_place;

LANES_INLINE table_place place_of_coordinate(lanes x) {
  lanes_int entry = lanes_truncate(x);
  return (table_place){x, entry, x - lanes_from_int(entry)};
}

LANES_INLINE table_place classify_place(const classifier *classifier, lanes density) {
  return place_of_coordinate(
      lanes_clamp(lanes_line(density, classifier->scale, classifier->offset), 0, CLASSIFIER_ENTRIES));
}

/* The values of a table's columns at a place. */
LANES_INLINE void table_values(float (*table)[4], table_place place, lanes values[3]) {
  lanes a[3], b[3];
  lanes_gather_row_pairs(&table[0][0], place.entry, a, b);
  for (int i = 0; i < 3; i++) values[i] = lanes_fma(b[i] - a[i], place.fraction, a[i]);
}

/* Closer than this many entries the integral's difference loses digits; the ends' mean is as good there. */
static const float NEAR_ENTRIES = 4;

/* The way from place a to place b. */
typedef struct way_sums {
  lanes extinction; /* its mean, (I(b) - I(a)) / (b - a) */
  lanes whole;      /* I(b) - I(a), 0 where the places are near */
  lanes moment;     /* the same of extinction * entry */
} way_sums;

LANES_INLINE way_sums sums_of_way(const classifier *classifier, table_place a, table_place b) {
  lanes at_a[3], at_b[3];
  table_values(classifier->sums, a, at_a);
  table_values(classifier->sums, b, at_b);
  lanes ends = (at_a[0] + at_b[0]) * 0.5f, distance = b.x - a.x;
  lanes_int far = lanes_abs(distance) > NEAR_ENTRIES;
  way_sums sums = {ends, lanes_keep(far, at_b[1] - at_a[1]), at_b[2] - at_a[2]};
  lanes mean = lanes_max(sums.whole / lanes_select(far, distance, lanes_set(1.0f)), lanes_set(0));
  sums.extinction = lanes_select(far, mean, ends);
  return sums;
}

/* Lanes in which anything between the two places can have extinction. */
LANES_INLINE lanes_int may_be_visible(const classifier *classifier, table_place a, table_place b) {
  return (lanes_max(a.x, b.x) > classifier->first_visible) & (lanes_min(a.x, b.x) < classifier->last_visible);
}

/* How far from a and from b on the way between them, weighted by extinction, the density lies, in entries; 1
 * and 1 where the way is short or holds nothing. */
typedef struct way_parts {
  lanes from_a, from_b;
} way_parts;

LANES_INLINE way_parts parts_of_way(lanes a, lanes b, const way_sums *sums) {
  lanes_int usable = lanes_abs(sums->whole) > 0.0f;
  lanes mean = sums->moment / lanes_select(usable, sums->whole, lanes_set(1.0f));
  mean = lanes_min(lanes_max(mean, lanes_min(a, b)), lanes_max(a, b));
  return (way_parts){lanes_select(usable, lanes_abs(mean - a), lanes_set(1.0f)),
                     lanes_select(usable, lanes_abs(mean - b), lanes_set(1.0f))};
}

#endif
