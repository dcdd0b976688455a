/* light/light_cone.h - the brightness of a spot light by direction. */
#ifndef HL_LIGHT_LIGHT_CONE_H
#define HL_LIGHT_LIGHT_CONE_H

#include "light/light_source.h"

/* Brightness is smoothstep((cos(angle to the axis) - outer) * scale): 0 outside the cone, 1 within its
 * edge. */
typedef struct light_cone {
  float axis[3]; /* unit, the way the light travels; frame space */
  float outer;   /* cosine where light begins */
  float scale;   /* 1 / (cosine where it is full - outer); 0: the light has no cone */
} light_cone;

/* content: the middle of the lit content; pixel: edge of a picture's pixel there, which the cone's edge is at
 * least as wide as; frame units. */
light_cone hl_light_cone(const light_source *source, vec3 content, double pixel);

#endif
