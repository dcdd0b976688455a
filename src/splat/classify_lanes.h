/* splat/classify_lanes.h - table lookups for sixteen densities. */
#ifndef HL_SPLAT_CLASSIFY_LANES_H
#define HL_SPLAT_CLASSIFY_LANES_H

#include "simd/lanes.h"
#include "splat/classify.h"

typedef struct table_place { lanes_int entry; lanes fraction; } table_place;

LANES_INLINE table_place classify_place(const classifier *classifier, lanes density) {
  lanes x = lanes_clamp(density * classifier->scale + classifier->offset, 0, CLASSIFIER_ENTRIES);
  lanes_int entry = lanes_truncate(x);
  return (table_place){entry, x - lanes_from_int(entry)};
}

LANES_INLINE lanes classify_value(const float *table, table_place place) {
  lanes a = lanes_gather(table, place.entry), b = lanes_gather(table + 1, place.entry);
  return a + (b - a) * place.fraction;
}

#endif
