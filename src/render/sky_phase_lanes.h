/* render/sky_phase_lanes.h - what a medium sends on of the sky's light, by its phase function.
 *
 * Harmonics tell the mean of light and phase function up to the second degree: too little for a function that
 * points forwards before a sky of which half is hidden. So the light is taken for an even one and a brighter
 * cap, whose mean a table has (phase_table.h), and harmonics correct that up to the second degree. */
#ifndef HL_RENDER_SKY_PHASE_LANES_H
#define HL_RENDER_SKY_PHASE_LANES_H

#include "field/lookup_lanes.h"
#include "render/phase_lanes.h"

/* Light of one brightness, and more within a cap of directions. */
typedef struct sky_cap {
  lanes even, more; /* means over all directions: of the one brightness, of what the cap has more */
  lanes cosine;     /* of the angle from the cap's middle to its edge */
  lanes3 middle;    /* unit */
} sky_cap;

/* The cap whose light has the mean and the flux that harmonics tell, and their second degree along the flux.
 * Derived: over a cap the mean of x, the cosine to its middle, is (1 + c) / 2, and that of (3 x^2 - 1) / 2 is
 * c (1 + c) / 2, so that c is their ratio, whatever light is even; but the cap has no more than all light. */
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

/* The mean of light and Henyey and Greenstein's phase function, whose factors for harmonics are g^l (derived
 * from its series in Legendre polynomials). onwards: where the eye's ray goes; table: null where g is 0. */
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
