/* light/light_sector.h - a light within or beside what it lights, cut by direction into sectors.
 *
 * Sheets serve rays that cross them in one sense and not too flatly. Around a light within the content there
 * are rays in all directions: six slicing axes share them, three that the eye looks along and three against
 * it, each crossed well by the eye's rays and by the light of its own sector. Shares fade into each other and
 * sum to one, so that no seam shows. */
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

/* The share of a sector: max(0, cos_i - least)^2 over the sum of that for all sectors, cos_i between a ray
 * and axis i. */
typedef struct sector_fraction {
  int count; /* 0: the light is whole */
  int sector;
  float axis[LIGHT_SECTORS][3];
  float least;
} sector_fraction;

/* sectors may be null: a whole light. */
sector_fraction hl_sector_fraction(const light_sectors *sectors, int sector);

#endif
