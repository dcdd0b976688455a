/* splat/classify_lanes.h - classification of the way from one sheet to the next, sixteen rays at a time. */
#ifndef HL_SPLAT_CLASSIFY_LANES_H
#define HL_SPLAT_CLASSIFY_LANES_H

#include "simd/lanes.h"
#include "splat/classify.h"

/* A place in the tables: entry + fraction. */
typedef struct table_place { lanes x; lanes_int entry; lanes fraction; } table_place;

LANES_INLINE table_place place_of_coordinate(lanes x) {
  lanes_int entry = lanes_truncate(x);
  return (table_place){x, entry, x - lanes_from_int(entry)};
}

LANES_INLINE table_place classify_place(const classifier *classifier, lanes density) {
  return place_of_coordinate(lanes_clamp(density * classifier->scale + classifier->offset, 0, CLASSIFIER_ENTRIES));
}

LANES_INLINE lanes table_value(const float *table, table_place place) {
  lanes a = lanes_gather(table, place.entry), b = lanes_gather(table + 1, place.entry);
  return a + (b - a) * place.fraction;
}

/* Closer than this many entries the integral's difference loses digits; the ends' mean is as good there. */
static const float NEAR_ENTRIES = 4;

/* Mean extinction between two places: (I(b) - I(a)) / (b - a). *whole: I(b) - I(a), 0 where they are near. */
LANES_INLINE lanes mean_extinction(const classifier *classifier, table_place a, table_place b, lanes *whole) {
  lanes ends = (table_value(classifier->extinction, a) + table_value(classifier->extinction, b)) * 0.5f;
  lanes distance = b.x - a.x;
  lanes_int far = lanes_abs(distance) > NEAR_ENTRIES;
  *whole = lanes_set(0);
  if (lanes_bits(far) == 0) return ends;
  *whole = lanes_keep(far, table_value(classifier->integral, b) - table_value(classifier->integral, a));
  return lanes_select(far, lanes_max(*whole / lanes_select(far, distance, lanes_set(1.0f)), lanes_set(0)), ends);
}

/* Lanes in which anything between the two places can have extinction. */
LANES_INLINE lanes_int may_be_visible(const classifier *classifier, table_place a, table_place b) {
  return (lanes_max(a.x, b.x) > classifier->first_visible) & (lanes_min(a.x, b.x) < classifier->last_visible);
}

/* How far along the way from a to b a place lies, 0 to 1; the middle where the way is short. */
LANES_INLINE lanes part_of_way(table_place a, table_place b, table_place place) {
  lanes way = b.x - a.x;
  lanes_int far = lanes_abs(way) > NEAR_ENTRIES;
  return lanes_select(far, (place.x - a.x) / lanes_select(far, way, lanes_set(1.0f)), lanes_set(0.5f));
}

/* The place between a and b where, weighted by extinction, the density lies; whole as mean_extinction gives it. */
LANES_INLINE table_place mean_place(const classifier *classifier, table_place a, table_place b, lanes whole) {
  lanes low = lanes_min(a.x, b.x), high = lanes_max(a.x, b.x), middle = (low + high) * 0.5f;
  lanes_int usable = lanes_abs(whole) > 0.0f;
  if (lanes_bits(usable) == 0) return place_of_coordinate(middle);
  lanes moment = table_value(classifier->moment, b) - table_value(classifier->moment, a);
  lanes mean = moment / lanes_select(usable, whole, lanes_set(1.0f));
  return place_of_coordinate(lanes_min(lanes_max(lanes_select(usable, mean, middle), low), high));
}

#endif
