/* field/lookup_lanes.h - the sky's light at samples: read between the cells of its field. */
#ifndef HL_FIELD_LOOKUP_LANES_H
#define HL_FIELD_LOOKUP_LANES_H

#include "field/harmonics.h"
#include "field/sky_field.h"
#include "simd/lanes.h"

/* The light that comes to sixteen samples, as spherical harmonics. */
typedef struct sky_harmonics {
  lanes of[3 * FIELD_HARMONICS]; /* [channels][FIELD_HARMONICS] */
} sky_harmonics;

/* A position between cells along one axis. */
LANES_INLINE void place_between_cells(const sky_light *sky, int axis, lanes position, int32_t first[LANES],
                                      float fraction[LANES]) {
  lanes at = lanes_line(position - sky->low[axis], sky->inverse_cell, -0.5f);
  at = lanes_clamp(at, 0, (float)sky->count[axis] - 1.001f);
  lanes_int whole = lanes_truncate(at);
  memcpy(first, &whole, sizeof whole);
  lanes_store(fraction, at - lanes_from_int(whole));
}

/* A cell counts at least this much beside others. */
static const float LEAST_COUNTED = 1.0f / 1024;

/* Trilinear weights of eight cells, times their transmittances, or, on a volume's surface (1), the cubes of
 * these: dark cells within matter do not darken what lies outside of it. They sum to 1. */
LANES_INLINE void weigh_cells(const float *const cells[8], int passing, const float fraction[3],
                              float surface, float weight[8]) {
  float sum = 0;
  for (int corner = 0; corner < 8; corner++) {
    float x = corner & 1 ? fraction[0] : 1 - fraction[0], y = corner & 2 ? fraction[1] : 1 - fraction[1],
          z = corner & 4 ? fraction[2] : 1 - fraction[2], passes = cells[corner][passing],
          counted = passes * (1 - surface + surface * passes * passes);
    weight[corner] = x * y * z * (counted > LEAST_COUNTED ? counted : LEAST_COUNTED);
    sum += weight[corner];
  }
  for (int corner = 0; corner < 8; corner++) weight[corner] = weight[corner] / sum;
}

/* The light between the eight cells around each of the active lanes' positions. surface: 1 on surfaces of a
 * volume's matter, 0 in media and on meshes. */
LANES_INLINE void look_up_sky(const sky_light *sky, lanes3 position, lanes surface, uint32_t active,
                              sky_harmonics *found) {
  const int harmonics = sky->channels * FIELD_HARMONICS;
  const size_t cell = (size_t)harmonics + 1, row = cell * (size_t)sky->count[0],
               slice = row * (size_t)sky->count[1];
  int32_t first[3][LANES];
  float fraction[3][LANES], surfaces[LANES], rows[3][LANES][LANES];
  place_between_cells(sky, 0, position.x, first[0], fraction[0]);
  place_between_cells(sky, 1, position.y, first[1], fraction[1]);
  place_between_cells(sky, 2, position.z, first[2], fraction[2]);
  lanes_store(surfaces, surface);
  memset(rows, 0, (size_t)sky->channels * sizeof rows[0]);
  for (uint32_t left = active; left != 0; left &= left - 1) {
    int lane = __builtin_ctz(left);
    const float *at = sky->field + (size_t)first[0][lane] * cell + (size_t)first[1][lane] * row +
                      (size_t)first[2][lane] * slice;
    const float *cells[8], within[3] = {fraction[0][lane], fraction[1][lane], fraction[2][lane]};
    float weight[8];
    for (int corner = 0; corner < 8; corner++)
      cells[corner] = at + (corner & 1 ? cell : 0) + (corner & 2 ? row : 0) + (corner & 4 ? slice : 0);
    weigh_cells(cells, harmonics, within, surfaces[lane], weight);
    for (int c = 0; c < sky->channels; c++) {
      lanes sum = lanes_set(0);
      for (int corner = 0; corner < 8; corner++)
        sum = lanes_add_scaled(sum, lanes_load(cells[corner] + c * FIELD_HARMONICS), weight[corner]);
      lanes_store(rows[c][lane], sum);
    }
  }
  for (int k = 0; k < harmonics; k++) {
    float column[LANES];
    for (int lane = 0; lane < LANES; lane++)
      column[lane] = rows[k / FIELD_HARMONICS][lane][k % FIELD_HARMONICS];
    found->of[k] = lanes_load(column);
  }
}

/* The second degree of the sum over harmonics of light times the harmonic towards d. */
LANES_INLINE lanes second_degree(const lanes *light, lanes3 d) {
  return (light[4] * d.x * d.y + light[5] * d.y * d.z + light[6] * d.z * d.x) * (float)HARMONIC_2 +
         light[7] * lanes_line(d.z * d.z, 3.0f, -1.0f) * (float)HARMONIC_20 +
         light[8] * (d.x * d.x - d.y * d.y) * (float)HARMONIC_22;
}

/* 1 / pi times the integral of light and cosine. The cosine's factors are 1, 2/3 and 1/4 (Ramamoorthi and
 * Hanrahan 2001, divided by pi). */
LANES_INLINE lanes light_of_surface(const lanes *light, lanes3 normal) {
  lanes sum = light[0] * (float)HARMONIC_0;
  lanes first = light[1] * normal.x + light[2] * normal.y + light[3] * normal.z;
  sum = lanes_add_scaled(sum, first, (float)HARMONIC_1 * (2.0f / 3));
  return lanes_max(lanes_add_scaled(sum, second_degree(light, normal), 0.25f), lanes_set(0));
}

#endif
