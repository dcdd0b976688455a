/* light/light_sector.c - the axes of a light's sectors. */
#include "light/light_sector.h"

/* Three axes at the angle phi to the eye's direction, and three to its opposite turned by 60 degrees: of an
 * octahedron seen along a face for phi = 54.7 degrees. With 45 degrees every direction lies within 59 degrees
 * of an axis. Wide pictures need axes closer to the eye's direction, so that their corners' rays still cross
 * the sheets. */
light_sectors hl_light_sectors(vec3 eye_direction, double widest) {
  const double usual = 45 * HL_PI / 180, flattest = 75 * HL_PI / 180, closest = 15 * HL_PI / 180;
  double phi = fmax(fmin(usual, flattest - widest), closest);
  vec3 u = vec3_perpendicular(eye_direction), v = vec3_cross(eye_direction, u);
  light_sectors sectors;
  for (int i = 0; i < LIGHT_SECTORS; i++) {
    double turn = i * HL_PI / 3, along = i % 2 == 0 ? cos(phi) : -cos(phi);
    vec3 across = vec3_add(vec3_scale(u, cos(turn)), vec3_scale(v, sin(turn)));
    sectors.axis[i] = vec3_add(vec3_scale(eye_direction, along), vec3_scale(across, sin(phi)));
  }
  /* Derived: half the cosine of a direction across the eye's that lies midway between two axes. */
  sectors.least = fmax(0.5 * cos(HL_PI / 6) * sin(phi), 0.1);
  return sectors;
}

sector_fraction hl_sector_fraction(const light_sectors *sectors, int sector) {
  sector_fraction fraction = {.count = sectors == 0 ? 0 : LIGHT_SECTORS, .sector = sector};
  for (int i = 0; i < fraction.count; i++) vec3_store(fraction.axis[i], sectors->axis[i]);
  fraction.least = fraction.count == 0 ? 0 : (float)sectors->least;
  return fraction;
}
