/* scene/light/light_shape.h - the shape of a light as geometry: centre, area, points, spread. */
#ifndef HL_SCENE_LIGHT_LIGHT_SHAPE_H
#define HL_SCENE_LIGHT_LIGHT_SHAPE_H

#include <halflight/scene.h>

#include "core/vector.h"

typedef struct light_kind light_kind; /* light_kind.h */

/* The shape of a light, which is made from the light's settings by the rules of its type. Lengths and
 * positions are in the space of the settings. Members that a type does not use are 0. */
typedef struct light_shape {
  const light_kind *kind;
  vec3 centre;       /* not of parallel lights */
  vec3 direction;    /* for parallel lights and lights with a cone: the way that the light travels, of any
                      * length */
  vec3 normal;       /* of a disk; unit */
  vec3 edge1, edge2; /* of a parallelogram: full edges */
  double radius;     /* for a sphere or a disk: its radius; for parallel light: the radius of the disk of
                      * directions, at distance 1 */
  double cone_half_angle, cone_edge; /* for a cone, in radians: half of its angle, beyond which there is no
                                      * light, and the width of the smooth edge inside it */
  const double (*vertices)[3];       /* for a polygon: [vertex_count]; borrowed from the settings */
  size_t vertex_count;
  vec3 image_up;    /* for an image on the light's surface: the direction in which its top lies */
  bool is_wide;     /* the light has more than one point, or more than one direction */
  bool has_surface; /* the light has a surface that can carry an image */
} light_shape;

typedef struct polygon_shape {
  vec3 normal; /* unit; zero where there is no area */
  double area;
  double diameter; /* greatest side of the box around the vertices */
  vec3 centre;     /* centre of the area */
  mat3 spread;     /* mean of (x - centre)(x - centre)' over the area */
} polygon_shape;

/* Finds the centre, area, normal and spread of a polygon. vertices: in order around the polygon, of either
 * sense; [count][3]. */
polygon_shape hl_polygon_shape(const double (*vertices)[3], size_t count);

/* Greatest distance of a vertex from the plane through the centre. */
double hl_polygon_unevenness(const polygon_shape *shape, const double (*vertices)[3], size_t count);

/* Whether two edges cross each other (touching is not crossing). */
bool hl_polygon_crosses_itself(const polygon_shape *shape, const double (*vertices)[3], size_t count);

/* The plane of a light's emission image. Positions in it are offsets from the light's centre; for parallel
 * light, offsets at distance 1 from the direction to the light. */
typedef struct emission_plane {
  vec3 middle;    /* middle of the image */
  vec3 right, up; /* vectors from `middle` to the middles of the image's right and top edges */
} emission_plane;

/* Finds unit vectors to the right and upwards, as seen by someone who looks against a unit normal. */
void hl_upright(vec3 normal, vec3 wanted_up, vec3 *right, vec3 *up);

/* The image coordinates of an offset in the plane: s along right and t along up, each from -1 to 1 within the
 * image. */
void hl_emission_place(const emission_plane *plane, vec3 offset, double *s, double *t);

/* ---- disks; normal: unit ---- */

/* The offset from the centre of the disk's point for the point (a, b) of the unit square. Equal areas become
 * equal areas. */
vec3 hl_disk_point(vec3 normal, double radius, double a, double b);
mat3 hl_disk_spread(vec3 normal, double radius);
/* The square around the disk. */
emission_plane hl_disk_plane(vec3 normal, double radius, vec3 wanted_up);

/* ---- second moments ---- */

mat3 hl_outer(vec3 a, vec3 b); /* a b' */
mat3 hl_add_scaled(mat3 a, mat3 b, double scale);

#endif
