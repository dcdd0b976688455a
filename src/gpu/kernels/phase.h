/* gpu/kernels/phase.h - finds how much of a light a medium scatters towards the eye. The functions compute
 * for one pixel the same numbers as render/phase_lanes.h for sixteen pixels. */
#ifndef HL_GPU_PHASE_H
#define HL_GPU_PHASE_H

#include "gpu/device_sweep.h"
#include "gpu/kernels/numbers.h"

#define LEAST_LIGHT_DISTANCE 1e-3f /* as HL_LEAST_LIGHT_DISTANCE */

/* Henyey and Greenstein's phase function times 4 pi. turn: minus the cosine of the angle by which scattering
 * turns the light. */
DEVICE float phase_of(float g, float turn) {
  float squared = fused(turn, 2 * g, 1 + g * g);
  return divided(1 - g * g, squared * root(squared));
}

#if PHASES

/* The table of a volume's phase function (light/phase_table.h). */
typedef struct phase_data {
  GLOBAL const float *table; /* [lights][PLAN_PHASE_COLUMNS], for parallel lights; then
                              * [PLAN_PHASE_CAPS][PLAN_PHASE_COLUMNS][2], for caps of all sizes */
  int lights;
  float rows_per_log2;
} phase_data;

/* The members of phase_angle (render/phase_lanes.h). */
typedef struct phase_angle {
  int column;
  float fraction, phase;
} phase_angle;

DEVICE phase_angle phase_angle_at(float g, float turn) {
  const float size = magnitude(g), per_s = divided(PLAN_PHASE_COLUMNS - 1.0f, 2 * size);
  const float squared = greater(fused(turn, 2 * g, 1 + g * g), (1 - size) * (1 - size)), s = root(squared);
  const float at = limited(fused(s, per_s, (size - 1) * per_s), 0.0f, PLAN_PHASE_COLUMNS - 1 - 1e-3f);
  phase_angle angle;
  angle.column = (int)at;
  angle.fraction = at - (float)angle.column;
  angle.phase = divided(1 - g * g, squared * s);
  return angle;
}

DEVICE float row_of_ratio(const phase_data *phases, float ratio) {
  return limited(log_of_two(greater(ratio, 1.0f)) * phases->rows_per_log2, 0.0f, PLAN_PHASE_CAPS - 1 - 1e-3f);
}

DEVICE float mean_in_table(const phase_data *phases, float row, const phase_angle *angle) {
  const int first = (int)row;
  const float between = row - (float)first;
  GLOBAL const float *square = phases->table + phases->lights * PLAN_PHASE_COLUMNS +
                               (first * PLAN_PHASE_COLUMNS + angle->column) * 2;
  const float close = fused(square[1] - square[0], between, square[0]),
              far = fused(square[3] - square[2], between, square[2]);
  return fused(far - close, angle->fraction, close) * angle->phase;
}

DEVICE float row_of_cap(const phase_data *phases, float size, GLOBAL const plan_cap *cap, vector way,
                        float inverse) {
  GLOBAL const float *spread = cap->spread;
  const float along = fused(way.x * spread[0], way.x, way.y * way.y * spread[1] + way.z * way.z * spread[2]);
  const float twice = fused(way.x * spread[3], way.y, way.z * (way.x * spread[4] + way.y * spread[5]));
  const float wide_by = (spread[0] + spread[1] + spread[2]) - (along + twice * 2.0f) * inverse;
  const float h = root(greater(fused(wide_by, inverse, 1.0f), 1.0f));
  const float most = divided(1.0f, (1 - size) * (1 - size));
  return row_of_ratio(phases,
                      fused(divided(1.0f, h + 1.0f), -8 * size * most, (1 + size) * (1 + size) * most));
}

DEVICE float phase_of_cap(const phase_data *phases, float g, GLOBAL const plan_cap *cap, vector position,
                          vector towards_eye) {
  const vector way = add_scaled(vector_at(cap->middle), position, -1.0f);
  const float inverse = divided(1.0f, greater(dot3(way, way), LEAST_LIGHT_DISTANCE * LEAST_LIGHT_DISTANCE));
  const float row = row_of_cap(phases, magnitude(g), cap, way, inverse);
  const phase_angle angle = phase_angle_at(g, dot3(towards_eye, way) * root(inverse));
  return mean_in_table(phases, row, &angle);
}

/* The mean of the phase function over a light. number: of the light. towards: unit vector to the light's
 * middle. */
DEVICE float phase_of_light(const phase_data *phases, float g, GLOBAL const plan_light *light, int number,
                            vector towards, vector position, vector towards_eye) {
  const float turn = dot3(towards_eye, towards);
  if (light->cap_count == 0 && !light->wide_parallel) return phase_of(g, turn);
  if (light->cap_count == 0) {
    const phase_angle angle = phase_angle_at(g, turn);
    GLOBAL const float *row = phases->table + number * PLAN_PHASE_COLUMNS + angle.column;
    return fused(row[1] - row[0], angle.fraction, row[0]) * angle.phase;
  }
  float sum = 0.0f;
  for (int i = 0; i < light->cap_count; i++)
    sum = sum + phase_of_cap(phases, g, &light->caps[i], position, towards_eye);
  return sum * divided(1.0f, (float)light->cap_count);
}

#endif

#endif
