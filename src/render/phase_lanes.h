/* render/phase_lanes.h - finds how much of a light a medium scatters towards the eye. */
#ifndef HL_RENDER_PHASE_LANES_H
#define HL_RENDER_PHASE_LANES_H

#include "render/slab_lanes.h"
#include "simd/gathers.h"

static const float LEAST_LIGHT_DISTANCE = (float)HL_LEAST_LIGHT_DISTANCE;

/* Henyey and Greenstein's phase function, "Diffuse radiation in the galaxy" (1941), times 4 pi, so that even
 * scattering has the value 1. The value is (1 - g^2) / (1 + g^2 - 2 g cos)^(3/2), where cos is the cosine of
 * the angle between the light's directions before and after scattering. turn: the number -cos. */
LANES_INLINE lanes phase(float g, lanes turn) {
  lanes squared = lanes_line(turn, 2 * g, 1 + g * g);
  return lanes_set(1 - g * g) / (squared * lanes_sqrt(squared));
}

/* The position of an angle among the columns of a phase table, and the value of the phase function p at this
 * angle. */
typedef struct phase_angle {
  lanes_int column;
  lanes fraction; /* the fraction of the way from the column to the next column */
  lanes phase;
} phase_angle;

/* turn: -cos, as in phase(). */
LANES_INLINE phase_angle phase_angle_at(float g, lanes turn) {
  const float size = fabsf(g), per_s = (PHASE_COLUMNS - 1) / (2 * size);
  lanes squared = lanes_max(lanes_line(turn, 2 * g, 1 + g * g), lanes_set((1 - size) * (1 - size)));
  lanes s = lanes_sqrt(squared);
  lanes at = lanes_clamp(lanes_line(s, per_s, (size - 1) * per_s), 0, PHASE_COLUMNS - 1 - 1e-3f);
  phase_angle angle = {.column = lanes_truncate(at), .phase = (1 - g * g) / (squared * s)};
  angle.fraction = at - lanes_from_int(angle.column);
  return angle;
}

/* The row of a phase table for a cap of light, as a fraction between two rows. ratio: the cap's s^2 divided
 * by the least s^2 of the table. */
LANES_INLINE lanes row_of_ratio(const phase_table *table, lanes ratio) {
  lanes row = lanes_log2(lanes_max(ratio, lanes_set(1.0f))) * table->rows_per_log2;
  return lanes_clamp(row, 0, PHASE_CAPS - 1 - 1e-3f);
}

/* The mean of the phase function over a cap. row: the row for the cap's size. angle: the angle to the middle
 * of the cap. */
LANES_INLINE lanes mean_in_table(const phase_table *table, lanes row, const phase_angle *angle) {
  lanes square[4];
  lanes_int first = lanes_truncate(row);
  lanes_gather_quads(&table->caps[0][0][0], (first * PHASE_COLUMNS + angle->column) * 2, square);
  lanes between = row - lanes_from_int(first);
  lanes near = lanes_fma(square[1] - square[0], between, square[0]),
        far = lanes_fma(square[3] - square[2], between, square[2]);
  return lanes_fma(far - near, angle->fraction, near) * angle->phase;
}

/* The row of a phase table for one cap of a light, seen along `way`, which need not have unit length.
 * inverse: 1 / |way|^2. */
LANES_INLINE lanes row_of_cap(const phase_table *table, float size, const light_cap *cap, lanes3 way,
                              lanes inverse) {
  const float *spread = cap->spread;
  lanes along = lanes_fma(way.x * spread[0], way.x, way.y * way.y * spread[1] + way.z * way.z * spread[2]);
  lanes twice = lanes_fma(way.x * spread[3], way.y, way.z * (way.x * spread[4] + way.y * spread[5]));
  lanes wide = (spread[0] + spread[1] + spread[2]) - (along + twice * 2.0f) * inverse;
  lanes h = lanes_sqrt(lanes_max(lanes_fma(wide, inverse, lanes_set(1.0f)), lanes_set(1.0f)));
  float most = 1 / ((1 - size) * (1 - size)); /* the reciprocal of the least s^2; the cosine of the cap's
                                               * angle is 4 / (1 + h) - 1 */
  lanes ratio = lanes_line(1.0f / (h + 1.0f), -8 * size * most, (1 + size) * (1 + size) * most);
  return row_of_ratio(table, ratio);
}

/* The mean of the phase function over one cap of a light. */
LANES_INLINE lanes phase_of_cap(const phase_table *table, float g, const light_cap *cap,
                                const block_geometry *geometry) {
  const float least = LEAST_LIGHT_DISTANCE * LEAST_LIGHT_DISTANCE;
  lanes3 way = add_scaled3(set3(cap->middle), geometry->position, lanes_set(-1.0f));
  lanes inverse = 1.0f / lanes_max(dot3(way, way), lanes_set(least));
  lanes row = row_of_cap(table, fabsf(g), cap, way, inverse);
  phase_angle angle = phase_angle_at(g, dot3(geometry->towards_eye, way) * lanes_sqrt(inverse));
  return mean_in_table(table, row, &angle);
}

/* The mean of the phase function over a light. towards: unit vector to the light's middle. table: the phase
 * table for the anisotropy g; null if no light is wide. */
LANES_INLINE lanes phase_of_light(const phase_table *table, float g, const shade_light *light, lanes3 towards,
                                  const block_geometry *geometry) {
  lanes turn = dot3(geometry->towards_eye, towards);
  if (table == NULL || (light->caps.count == 0 && light->parallel_row < 0)) return phase(g, turn);
  if (light->caps.count == 0) {
    phase_angle angle = phase_angle_at(g, turn);
    lanes from, to;
    lanes_gather_pairs(table->parallel[light->parallel_row], angle.column, &from, &to);
    return lanes_fma(to - from, angle.fraction, from) * angle.phase;
  }
  lanes sum = lanes_set(0);
  for (int i = 0; i < light->caps.count; i++)
    sum = sum + phase_of_cap(table, g, &light->caps.cap[i], geometry);
  return sum * (1.0f / (float)light->caps.count);
}

#endif
