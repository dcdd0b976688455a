/* scene/light_shape.h - the shapes of extended lights as geometry: centre, area, spread. */
#ifndef HL_SCENE_LIGHT_SHAPE_H
#define HL_SCENE_LIGHT_SHAPE_H

#include <halflight/scene.h>

#include "core/vector.h"

typedef struct polygon_shape {
  vec3 normal; /* unit; zero where there is no area */
  double area;
  double diameter; /* of the vertices' bounds: the greatest side */
  vec3 centre;     /* of area */
  mat3 spread;     /* mean of (x - centre)(x - centre)' over the area */
} polygon_shape;

/* vertices: in order around the polygon, of either sense; [count][3]. */
polygon_shape hl_polygon_shape(const double (*vertices)[3], size_t count);

/* Greatest distance of a vertex from the plane through the centre. */
double hl_polygon_unevenness(const polygon_shape *shape, const double (*vertices)[3], size_t count);

/* Whether two edges cross each other (touching is not crossing). */
bool hl_polygon_crosses_itself(const polygon_shape *shape, const double (*vertices)[3], size_t count);

/* The light's centre, world; not for directional lights. */
vec3 hl_light_centre(const hl_light *light);

/* Mean of (x - centre)(x - centre)' over the light: a rect has (e1 e1' + e2 e2') / 12, a disk r^2/4 (1 - n
 * n'). Spheres, and the directions of parallel light at distance 1, count as the disk perpendicular to
 * `facing` (unit). */
mat3 hl_light_spread(const hl_light *light, vec3 facing);

/* The plane of a light's emission image: offsets from the light's centre, or for parallel light from the
 * direction towards it, at distance 1. */
typedef struct emission_plane {
  vec3 middle;    /* of the image */
  vec3 right, up; /* from there to the middles of its right and top edges */
} emission_plane;

/* facing: unit, from the light to the content; for spheres and directional lights. */
emission_plane hl_emission_plane(const hl_light *light, vec3 facing);

/* The image coordinates of an offset in the plane: s along right and t along up, each from -1 to 1 within the
 * image. */
void hl_emission_place(const emission_plane *plane, vec3 offset, double *s, double *t);

#endif
