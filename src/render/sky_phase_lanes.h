/* render/sky_phase_lanes.h - finds the light of the sky that a medium sends to the eye, by the medium's phase
 * function.
 *
 * The harmonics give the mean of light times phase function up to the second degree. This is not enough if
 * the medium scatters mostly forwards and half of the sky is hidden. So the light is modelled as even light
 * plus a brighter cap. A table gives the mean over the cap (phase_table.h). The harmonics then correct the
 * result up to the second degree. */
#ifndef HL_RENDER_SKY_PHASE_LANES_H
#define HL_RENDER_SKY_PHASE_LANES_H

#include "field/lookup_lanes.h"
#include "render/phase_lanes.h"

/* A model of the sky's light: even light from all directions, plus more light from a cap of directions. */
typedef struct sky_cap {
  lanes even, more; /* the mean of the even light over all directions, and the mean of the cap's light */
  lanes cosine;     /* cosine of the angle from the cap's middle to its edge */
  lanes3 middle;    /* unit */
} sky_cap;

/* Finds the cap whose light has the same mean and the same flux as the harmonics, and the same second degree
 * along the flux. Derived: let x be the cosine of the angle to the cap's middle, and c the cosine at its
 * edge. The mean of x over the cap is (1 + c) / 2, and the mean of (3 x^2 - 1) / 2 is c (1 + c) / 2. So c is
 * the ratio of these two means, however much of the light is even. The cap gets at most all of the light. */
LANES_INLINE sky_cap cap_of_sky(const lanes *light) {
  sky_cap cap;
  lanes mean = light[0] * (float)HARMONIC_0, least = lanes_set(1e-12f);
  lanes3 flux = scale3((lanes3){light[1], light[2], light[3]}, lanes_set((float)HARMONIC_1 / 3));
  lanes length = lanes_max(lanes_sqrt(dot3(flux, flux)), least), inverse = 1.0f / length;
  cap.middle = scale3(flux, inverse);
  lanes of_all = length * 2.0f / lanes_max(mean, least) - 1.0f;
  lanes ratio = second_degree(light, cap.middle) * 0.2f * inverse;
  cap.cosine = lanes_clamp(lanes_max(ratio, of_all), -1, 1);
  cap.more = lanes_min(length * 2.0f / lanes_max(cap.cosine + 1.0f, lanes_set(1e-6f)), mean);
  cap.even = mean - cap.more;
  return cap;
}

/* The mean, over all directions, of the light times Henyey and Greenstein's phase function. The factors of
 * this function for harmonics of degree l are g^l (derived from its series in Legendre polynomials). onwards:
 * the direction of the eye's ray. table: null if g is 0. */
LANES_INLINE lanes light_of_medium(const phase_table *table, float g, const lanes *light, lanes3 onwards) {
  if (g == 0) return lanes_max(light[0] * (float)HARMONIC_0, lanes_set(0));
  const float size = fabsf(g), most = 1 / ((1 - size) * (1 - size));
  sky_cap cap = cap_of_sky(light);
  lanes x = dot3(cap.middle, onwards);
  phase_angle angle = phase_angle_at(g, -x);
  lanes row = row_of_ratio(table, lanes_line(cap.cosine, -2 * size * most, (1 + size * size) * most));
  lanes sum = lanes_fma(cap.more, mean_in_table(table, row, &angle), cap.even);
  lanes second = cap.more * cap.cosine * (cap.cosine + 1.0f) * lanes_line(x * x, 3.75f, -1.25f);
  return lanes_max(lanes_add_scaled(sum, second_degree(light, onwards) - second, g * g), lanes_set(0));
}

#endif
