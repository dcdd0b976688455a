/* scene/light/sky.h - finds the radiance of a sky in a direction. */
#ifndef HL_SCENE_LIGHT_SKY_H
#define HL_SCENE_LIGHT_SKY_H

#include <halflight/scene.h>

#include "core/key.h"
#include "core/vector.h"
#include "scene/check/checker.h"

/* The sky's own axes: unit vectors in the world, at right angles to each other. */
typedef struct sky_axes {
  vec3 right, middle, up; /* middle: points to the image's middle column; right: points to the right of the
                           * image */
} sky_axes;

sky_axes hl_sky_axes(const hl_sky *sky);

/* The radiance of the sky, times its strength, in a direction (unit, world, towards the sky). The radiance is
 * 0 below the horizon of a hemisphere, and in a scene without a sky. */
void hl_sky_radiance(const hl_sky *sky, const sky_axes *axes, vec3 direction, double radiance[3]);

/* Adds everything on which a sky's radiance depends to a key. mark: the number that identifies the image's
 * pixels (hl_scene.sky_mark). */
void hl_sky_key_add(hl_key *key, const hl_sky *sky, uint64_t mark);

hl_status hl_sky_check(const hl_sky *sky, hl_error *error);

#endif
