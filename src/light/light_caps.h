/* light/light_caps.h - describes an extended light, as a point within media sees it, by a few round caps of
 * directions.
 *
 * Scattering in media depends on the angle to the light, so media need to know how wide the light looks. A
 * parallel light looks the same from everywhere, and is one cap of directions. Other lights are cut into
 * parts. Each part is replaced by a round cap of directions. The mean cosine of the angle to the part's
 * middle is the same for the cap as for the part. Derived: with h = sqrt(1 + q^2), a disk of radius q at
 * distance 1, at a right angle to the view, has the mean cosine 2 (h - 1) / q^2. A cap within an angle of
 * cosine c has the mean cosine (1 + c) / 2. So c = (3 - h) / (1 + h). */
#ifndef HL_LIGHT_LIGHT_CAPS_H
#define HL_LIGHT_LIGHT_CAPS_H

#include "light/light_source.h"

enum { MOST_CAPS = 4 };

/* A part of a light. */
typedef struct light_cap {
  float middle[3]; /* the mean position of the part's points; frame space */
  float spread[6]; /* twice the mean of the matrix x x', where x is the vector from the part's middle to a
                    * point of the part. The elements are xx, yy, zz, xy, xz, yz. Seen along a unit vector w,
                    * the part counts as a disk of the squared radius xx + yy + zz - w' spread w */
} light_cap;

typedef struct light_caps {
  int count; /* number of parts; 0 if the light is parallel or a point, and so is not divided into parts */
  light_cap cap[MOST_CAPS];
} light_caps;

light_caps hl_light_caps(const light_source *source);

#endif
