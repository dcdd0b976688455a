/* light/light_source.h - a scene's light in frame space. */
#ifndef HL_LIGHT_LIGHT_SOURCE_H
#define HL_LIGHT_LIGHT_SOURCE_H

#include <halflight/scene.h>

#include "light/light_sector.h"

enum { HL_CHANNELS = 3 }; /* R, G, B */

typedef struct light_source {
  bool parallel;
  vec3 direction; /* unit, the way light travels: parallel, a spot light's axis, or from the
                     light's centre to its screen's or the content's */
  vec3 position;  /* of the light's centre, unless parallel; frame space */
  vec3 content;   /* the content's middle; frame space */
  mat3
      spread; /* mean of x x' over the light, from its centre; parallel: over the directions, at distance 1 */
  hl_shadows shadows; /* off, hard or soft */
  hl_soft_method soft_method;
  const hl_light *light;
  int light_index;              /* in the scene */
  const light_sectors *sectors; /* the frame's, where this is one sector of a light; else null */
  int sector;
  vec3 screen_center, screen_right, screen_up; /* of a light with a texture: the light screen; frame space */
} light_source;

/* light: in frame space. content: the content's middle. */
light_source hl_light_source(const hl_light *light, const hl_render_settings *settings, vec3 content);

/* One sector of a light, which must not be parallel. */
light_source hl_light_in_sector(const light_source *whole, const light_sectors *sectors, int sector);

#endif
