/* gpu/kernels/matter.h - evaluates the transfer function along a pixel's way through a slab. The functions
 * compute for one pixel the same numbers as grid/classifier_lanes.h and parts of render/slab_lanes.h for
 * sixteen. */
#ifndef HL_GPU_MATTER_H
#define HL_GPU_MATTER_H

#include "core/sheet_constants.h"
#include "gpu/kernels/mask.h"
#include "gpu/kernels/plane.h"
#include "gpu/kernels/sample.h"

/* Whether extinction depends on more than the value, so that a factor multiplies it. */
#define WEIGHED (STEEP || MASKED || PLANE)

/* A coordinate in the tables: x = entry + fraction. */
typedef struct table_coordinate {
  float x;
  int entry;
  float fraction;
} table_coordinate;

DEVICE table_coordinate split_coordinate(float x) {
  table_coordinate at;
  at.x = x;
  at.entry = (int)x;
  at.fraction = x - (float)at.entry;
  return at;
}
/* The coordinate of a density in the tables that tell whether the density shows. The coordinate is not
 * clamped. */
DEVICE float shown_coordinate(GLOBAL const plan_volume *volume, float density) {
  return fused(density, volume->scale, volume->offset);
}
DEVICE table_coordinate coordinate_of_density(GLOBAL const plan_volume *volume, float density) {
  return split_coordinate(limited(shown_coordinate(volume, density), 0.0f, PLAN_ENTRIES));
}

DEVICE GLOBAL const float *sums_table(GLOBAL const float *tables) { return tables; }
DEVICE GLOBAL const float *color_table(GLOBAL const float *tables) { return tables + PLAN_TABLE_ROWS * 4; }
DEVICE GLOBAL const float *shown_table(GLOBAL const float *tables) { return tables + PLAN_TABLE_ROWS * 8; }
/* For the values from an entry to the next one: the integral of extinction, from entry 0 to the coordinate at
 * which the surface of these values begins. */
DEVICE float beginning_at(GLOBAL const float *tables, int entry) { return sums_table(tables)[entry * 4 + 3]; }
DEVICE GLOBAL const float *outside_table(GLOBAL const float *tables) { return tables + PLAN_TABLE_ROWS * 12; }
DEVICE GLOBAL const float *bent_table(GLOBAL const float *tables) { return tables + PLAN_TABLE_ROWS * 13; }

DEVICE GLOBAL const float *steepness_table(GLOBAL const float *tables) {
  return tables + PLAN_TABLE_ROWS * 14;
}
DEVICE GLOBAL const float *shown_values_table(GLOBAL const float *tables) {
  return tables + PLAN_SHOWN_VALUES;
}

/* A table's first columns at a coordinate. */
DEVICE void table_values(GLOBAL const float *table, table_coordinate at, int columns, float values[4]) {
  GLOBAL const float *row = table + at.entry * 4;
  for (int i = 0; i < columns; i++) values[i] = fused(row[4 + i] - row[i], at.fraction, row[i]);
}

/* Integrals of a table from one coordinate to another. */
typedef struct way_sums {
  float extinction, integral, moment;
  float to_a, to_b; /* the integrals of extinction from entry 0 */
} way_sums;

DEVICE way_sums sums_of_way(GLOBAL const float *tables, table_coordinate a, table_coordinate b) {
  float at_a[4], at_b[4];
  table_values(sums_table(tables), a, 3, at_a);
  table_values(sums_table(tables), b, 3, at_b);
  float ends = (at_a[0] + at_b[0]) * 0.5f, distance = b.x - a.x;
  int far = magnitude(distance) > CLOSE_ENTRIES;
  way_sums sums;
  sums.integral = far ? at_b[1] - at_a[1] : 0.0f;
  sums.moment = at_b[2] - at_a[2];
  sums.to_a = at_a[1];
  sums.to_b = at_b[1];
  sums.extinction = far ? greater(divided(sums.integral, distance), 0.0f) : ends;
  return sums;
}

DEVICE int may_be_visible(GLOBAL const plan_volume *volume, table_coordinate a, table_coordinate b) {
  return greater(a.x, b.x) > volume->first_visible && lesser(a.x, b.x) < volume->last_visible;
}

typedef struct way_means {
  float from_a, from_b;
} way_means;

DEVICE way_means means_of_way(float a, float b, const way_sums *sums) {
  way_means means;
  means.from_a = means.from_b = 1.0f;
  if (!(magnitude(sums->integral) > 0.0f)) return means;
  float mean = divided(sums->moment, sums->integral);
  mean = lesser(greater(mean, lesser(a, b)), greater(a, b));
  means.from_a = magnitude(mean - a);
  means.from_b = magnitude(mean - b);
  return means;
}

/* The factor by which gradient opacity multiplies extinction, as factor_of_slope() in
 * fill/steepness_lanes.h. slope: the gradient; stored units per frame unit. */
DEVICE float factor_of_slope(const volume_data *volume, vector slope) {
  const vector steps = scaled(slope, volume->plan->steepness_scale);
  const table_coordinate at = split_coordinate(limited(root(dot3(steps, steps)), 0.0f, PLAN_ENTRIES));
  GLOBAL const float *factor = steepness_table(volume->tables) + at.entry;
  return fused(factor[1] - factor[0], at.fraction, factor[0]);
}

DEVICE mask_data mask_of_volume(const volume_data *volume) {
  mask_data mask;
  mask.plan = &volume->plan->mask;
  mask.data = volume->mask;
  return mask;
}

DEVICE plane_data plane_of_volume(const volume_data *volume) {
  plane_data plane;
  plane.sums = volume->tables + PLAN_TABLE_FLOATS;
  plane.color = plane.sums + PLAN_PLANE_FLOATS;
  plane.column_scale = volume->plan->column_scale;
  plane.column_offset = volume->plan->column_offset;
  return plane;
}

/* Returns whether a volume's factor on extinction depends on the gradient, so that the gradient is known
 * where the factor is. */
DEVICE int knows_gradient(const volume_data *volume) {
  (void)volume;
  return (STEEP && HAS(volume->plan, steep)) || (PLANE && HAS(volume->plan, plane));
}

/* Returns whether a volume has a factor on extinction. */
DEVICE int is_weighed(const volume_data *volume) {
  return knows_gradient(volume) || (MASKED && HAS(volume->plan, masked));
}

/* The factor by which gradient opacity, a mask and a function of value and gradient multiply extinction. */
typedef struct matter_factor {
  float factor;
  vector slope; /* the gradient, if the factor depends on it, else 0 */
  float row;    /* the gradient's row in the tables of a function of value and gradient */
} matter_factor;

/* Finds the factor at a point of frame space, as factor_of_matter() in fill/steepness_lanes.h. from, to: the
 * coordinates in the tables at the ends of the way. extinction: its mean extinction by the tables alone. */
DEVICE matter_factor factor_of_matter(const volume_data *volume, vector point, float from, float to,
                                      float extinction) {
  matter_factor found;
  found.factor = 1.0f;
  found.row = 0.0f;
  found.slope = vector_of(0.0f, 0.0f, 0.0f);
#if STEEP || PLANE
  if (knows_gradient(volume)) found.slope = gradient_at(*volume, point);
#endif
#if STEEP
  if (HAS(volume->plan, steep)) found.factor = factor_of_slope(volume, found.slope);
#endif
#if MASKED
  if (HAS(volume->plan, masked)) {
    const mask_data mask = mask_of_volume(volume);
    found.factor = found.factor * mask_factor(&mask, point);
  }
#endif
#if PLANE
  if (HAS(volume->plan, plane)) {
    const plane_data plane = plane_of_volume(volume);
    found.row = row_of_slope(found.slope, volume->plan->row_scale, volume->plan->row_offset);
    found.factor = found.factor *
                   divided(extinction_in_row(&plane, found.row, from, to), greater(extinction, 1e-30f));
  }
#else
  (void)from, (void)to, (void)extinction;
#endif
  return found;
}

/* Moves the coordinates a and b from the slab's two sheets to the ends of the slab's covered part.
 * Coordinates change linearly between the sheets. */
DEVICE void cut_way(covered_span span, table_coordinate *a, table_coordinate *b) {
  float from = a->x, way = b->x - a->x;
  *a = split_coordinate(fused(way, span.begin, from));
  *b = split_coordinate(fused(way, lesser(span.begin + span.length, 1.0f), from));
}

#endif
