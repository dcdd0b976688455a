/* light/light_sector.h - a light within or beside what it lights, cut by direction into sectors.
 *
 * All rays must cross the sheets in the same sense and not too flatly. A light within the content sends rays
 * in all directions, so they are divided among six slicing axes: three roughly along the eye's direction and
 * three roughly against it, each crossed well by the eye's rays and by the light of its own sector. The
 * sectors' fractions fade into each other and sum to one, so that no seam shows. */
#ifndef HL_LIGHT_LIGHT_SECTOR_H
#define HL_LIGHT_LIGHT_SECTOR_H

#include "core/vector.h"

enum { LIGHT_SECTORS = 6 };

typedef struct light_sectors {
  vec3 axis[LIGHT_SECTORS]; /* unit, the way a sector's light travels; frame space */
  double least;             /* cosine to its axis at which a sector has faded out */
} light_sectors;

/* eye_direction: unit; widest: the angle of the eye's outermost ray to it, radians. */
light_sectors hl_light_sectors(vec3 eye_direction, double widest);

/* The fraction of a ray's light that sector i takes: max(0, cos_i - least)^2 over the sum of this for all
 * sectors, cos_i the cosine between the ray and axis i. */
typedef struct sector_fraction {
  int count; /* 0: the light is whole */
  int sector;
  float axis[LIGHT_SECTORS][3];
  float least;
} sector_fraction;

/* sectors may be null: a whole light. */
sector_fraction hl_sector_fraction(const light_sectors *sectors, int sector);

#endif
