/* scene/light/suns.h - finds the suns of a sky's image: compact bright spots, which become lights of their
 * own.
 *
 * A sun gets the light of its spot that exceeds the brightest pixel of the surroundings; this light is taken
 * out of the image. The rest of the image and the suns together send the same light as the image, in each
 * channel. */
#ifndef HL_SCENE_LIGHT_SUNS_H
#define HL_SCENE_LIGHT_SUNS_H

#include <halflight/scene.h>

#include "core/error.h"
#include "core/vector.h"

enum { HL_MOST_SUNS = 4 };

/* A sun: a uniform disk that sends as much light as its spot, and whose directions have the same first and
 * second moments. */
typedef struct sky_sun {
  /* unit vector towards the sun's middle, in the sky's own axes (scene/light/sky.h): x right, y middle, z
   * up */
  vec3 towards;
  double half_angle;    /* angle from the sun's middle to its rim, radians */
  double straight;      /* length of the mean of all unit vectors towards the sun; below 1 */
  double irradiance[3]; /* integral of the sun's radiance over its directions, without the sky's strength */
} sky_sun;

typedef struct sky_suns {
  /* the suns in the order in which they were found; the spot of the first sun has the brightest pixel */
  sky_sun suns[HL_MOST_SUNS];
  int count;
  float *rest; /* owned; [height][width][3]: the image without the suns; null if the image has no suns */
} sky_suns;

/* Finds the suns of a sky that is an image. Skies of other kinds have no suns. */
hl_status hl_suns_find(hl_context *context, const hl_sky *sky, sky_suns *found, hl_error *error);
void hl_suns_release(hl_context *context, sky_suns *found);

/* Makes the parallel light, in the world, that shines as a sun of this sky does. */
hl_light hl_sun_light(const hl_sky *sky, const sky_sun *sun);

/* The fraction of a sun's light that lights media. */
static inline double hl_sun_part_of_media(const sky_sun *sun) { return 1 / (4 * sun->straight); }

#endif
