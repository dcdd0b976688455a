/* light/light_cone.h - how bright a spot light is in a direction. */
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

/* pixel: edge of a picture's pixel at content, the middle of what is lit: no edge is sharper; frame units. */
light_cone hl_light_cone(const light_source *source, vec3 content, double pixel);

#endif
