/* light/light_source.h - a scene's light in frame space: the whole light or one of its sectors, the
 * brightness of a spot light by direction, and the region that a light lights.
 *
 * All rays must cross the sheets in the same sense and not too flatly. A light within or beside the content
 * sends rays in all directions, so they are divided among six slicing axes: three roughly along the eye's
 * direction and three roughly against it, each crossed well by the eye's rays and by the light of its own
 * sector. The sectors' fractions fade into each other and sum to one, so that no seam shows. */
#ifndef HL_LIGHT_LIGHT_SOURCE_H
#define HL_LIGHT_LIGHT_SOURCE_H

#include <halflight/scene.h>

#include "core/vector.h"
#include "view/view.h"

enum { HL_CHANNELS = 3 }; /* R, G, B */

enum { LIGHT_SECTORS = 6 };

/* Lights that share one pass over the sheets, at most. */
enum { MAXIMUM_SWEEP_LIGHTS = 16 };

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
  double of_sky;   /* a sun of the sky, which makes no highlights: the part of its light that a medium takes;
                      else 0 */
  int light_index; /* in the scene */
  int row;         /* in the frame's list of lights */
  const light_sectors *sectors; /* the frame's, where this is one sector of a light; else null */
  int sector;
  vec3 screen_center, screen_right, screen_up; /* of a light with a texture: the light screen; frame space */
} light_source;

/* light: in frame space. content: the content's middle. */
light_source hl_light_source(const hl_light *light, const hl_render_settings *settings, vec3 content);

/* One sector of a light, which must not be parallel. */
light_source hl_light_in_sector(const light_source *whole, const light_sectors *sectors, int sector);

/* ---- The brightness of a spot light by direction ---- */

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

/* ---- The region of a light's view that its screen, its cone or its sector lights ---- */

/* Cuts bounds, in coordinates of a view from the light, down to the lit region; to a point where they do not
 * overlap it. */
void hl_lit_region(const view *view, const light_source *source, double low[2], double high[2]);

#endif
