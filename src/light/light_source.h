/* light/light_source.h - describes a scene's light in frame space: the whole light or one of its sectors, the
 * brightness of a spot light by direction, and the region that a light lights.
 *
 * All rays of a pass over the sheets must cross the sheets in the same direction and not too flatly. A light
 * within or beside the content sends rays in all directions, so its rays are divided among six sectors, each
 * with a slicing axis of its own: three axes roughly along the eye's direction and three roughly against it.
 * The eye's rays, and the light's rays within a sector, cross the sheets of the sector's axis at steep enough
 * angles. Sectors overlap. Each sector has a fraction of a ray's light, and the fractions of all sectors add
 * up to 1, so that no seam shows. */
#ifndef HL_LIGHT_LIGHT_SOURCE_H
#define HL_LIGHT_LIGHT_SOURCE_H

#include "scene/light/light_kind.h"
#include "view/view.h"

enum { HL_CHANNELS = 3 }; /* the colour channels of light: R, G, B */

enum { LIGHT_SECTORS = 6 };

/* The greatest number of lights that share one pass over the sheets. */
enum { MAXIMUM_SWEEP_LIGHTS = 16 };

typedef struct light_sectors {
  vec3 axis[LIGHT_SECTORS]; /* for each sector, the unit vector along which its light travels; frame space */
  double least;             /* the cosine of an angle: at this angle from its axis, a sector's fraction of the
                             * light has fallen to 0 */
} light_sectors;

/* Finds the axes of sectors. eye_direction: unit vector. widest: the angle between the eye's direction and
 * its outermost ray, radians. */
light_sectors hl_light_sectors(vec3 eye_direction, double widest);

/* The fraction of a ray's light that belongs to sector i. The fraction is max(0, cos_i - least)^2, divided by
 * the sum of these squares over all sectors. cos_i is the cosine of the angle between the ray and axis i. */
typedef struct sector_fraction {
  int count; /* number of sectors; 0 if the fraction belongs to a whole light */
  int sector;
  float axis[LIGHT_SECTORS][3];
  float least;
} sector_fraction;

/* Makes the fraction of a sector. If sectors is null, makes the fraction of a whole light. */
sector_fraction hl_sector_fraction(const light_sectors *sectors, int sector);

/* A picture that a light projects, or that is on the light's surface. */
typedef struct light_picture {
  const float *pixels; /* borrowed from the scene; [height][width][3]: linear RGB, top row first; null if the
                        * light has no such picture */
  int width, height;
} light_picture;

/* The picture that a light projects, and the screen on which it stands; frame space. */
typedef struct light_screen {
  light_picture picture;
  vec3 center, right, up; /* the middle of the screen, and the vectors from there to the middles of its right
                           * and top edges */
} light_screen;

typedef struct light_source {
  bool parallel;
  vec3 direction; /* unit vector along which light travels: a parallel light's direction or a spot light's
                   * axis; for other lights, the direction from the light's centre to the centre of its
                   * screen, or without a screen to the content's middle */
  vec3 position;  /* position of the light's centre, for lights that are not parallel; frame space */
  vec3 content;   /* the content's middle; frame space */
  mat3 spread;    /* mean of the matrix x x' over the light. x is the offset of a point of the light from the
                   * light's centre. For parallel light, directions count as points at the distance 1, and x
                   * is the offset of a direction from the mean direction */
  hl_shadows shadows; /* whether the light's shadows are off, hard or soft */
  hl_soft_method soft_method;
  light_shape shape;      /* the light's shape in frame space; the vertices of a polygon are borrowed until
                           * the frame ends */
  light_screen screen;    /* the picture that the light projects */
  light_picture emission; /* the picture on the light's own surface */
  double of_sky;   /* the fraction of the light that lights media, if the light is a sun of the sky, which
                    * makes no highlights; 0 for other lights */
  int light_index; /* index of the light in the scene */
  int row;         /* index of this source in the frame's list of lights */
  const light_sectors *sectors; /* the frame's sectors, if this source is one sector of a light; else null */
  int sector;
} light_source;

/* Makes the source of a light. light: the light in frame space; it must live, with its vertices, as long as
 * the source. content: the content's middle. */
light_source hl_light_source(const hl_light *light, const hl_render_settings *settings, vec3 content);

/* Makes the source of one sector of a light, which must not be parallel. */
light_source hl_light_in_sector(const light_source *whole, const light_sectors *sectors, int sector);

/* ---- The brightness of a spot light by direction ---- */

/* The brightness of a spot light in a direction is smoothstep((cos(angle to the axis) - outer) * scale). The
 * brightness is 0 outside the cone, and 1 inside the cone's soft edge. */
typedef struct light_cone {
  float axis[3]; /* unit vector along which light travels in the middle of the cone; frame space */
  float outer;   /* cosine of the angle at which the cone's light begins */
  float scale;   /* 1 / (inner - outer), where `inner` is the cosine of the angle within which brightness is
                  * full; 0 if the light has no cone */
} light_cone;

/* Makes the cone of a light. content: the middle of the lit content. pixel: edge of a picture's pixel at this
 * middle, frame units. The soft edge of the cone is at least one pixel of the picture wide. */
light_cone hl_light_cone(const light_source *source, vec3 content, double pixel);

/* ---- The region of a light's view that its screen, its cone or its sector lights ---- */

/* Cuts the bounds of a picture, in coordinates of a view from the light, down to the region that the light's
 * screen, cone or sector lights. Bounds that do not overlap the lit region become a point. */
void hl_lit_region(const view *view, const light_source *source, double low[2], double high[2]);

#endif
