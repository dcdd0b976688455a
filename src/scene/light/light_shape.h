/* scene/light/light_shape.h - describes the shape of a light as geometry: centre, area, points, spread. */
#ifndef HL_SCENE_LIGHT_LIGHT_SHAPE_H
#define HL_SCENE_LIGHT_LIGHT_SHAPE_H

#include <halflight/scene.h>

#include "core/vector.h"

typedef struct light_kind light_kind; /* see light_kind.h */

/* The shape of a light, which is made from the light's settings by the rules of its type. Lengths and
 * positions are in the space of the settings. Members that a type does not use are 0. */
typedef struct light_shape {
  const light_kind *kind;
  vec3 centre;       /* the light's centre; not used for parallel lights */
  vec3 direction;    /* for parallel lights and lights with a cone: the direction in which the light travels,
                      * of any length */
  vec3 normal;       /* for a disk: its unit normal */
  vec3 edge1, edge2; /* for a parallelogram: its two edges, in full length */
  double radius;     /* for a sphere or a disk: its radius; for parallel light: the radius of the disk of
                      * directions, at distance 1 */
  double cone_half_angle, cone_edge; /* for a cone, in radians: half of its angle, beyond which no light
                                      * shines, and the width of the smooth edge inside this angle */
  /* for a polygon: [vertex_count]; its vertices, borrowed from the settings */
  const double (*vertices)[3];
  size_t vertex_count;
  vec3 image_up;    /* for an image on the light's surface: the direction of the image's top */
  bool is_wide;     /* whether the light has more than one point, or more than one direction */
  bool has_surface; /* whether the light has a surface that can carry an image */
} light_shape;

typedef struct polygon_shape {
  vec3 normal; /* unit normal; zero if the polygon has no area */
  double area;
  double diameter; /* the greatest side of the box around the vertices */
  vec3 centre;     /* the centre of the polygon's area */
  mat3 spread;     /* mean of the matrix (x - centre)(x - centre)' over the polygon's points x */
} polygon_shape;

/* Finds the centre, area, normal and spread of a polygon. vertices: [count][3]; in order around the polygon,
 * clockwise or counter-clockwise. */
polygon_shape hl_polygon_shape(const double (*vertices)[3], size_t count);

/* The greatest distance of a polygon's vertex from the plane through its centre. */
double hl_polygon_unevenness(const polygon_shape *shape, const double (*vertices)[3], size_t count);

/* Whether two edges of a polygon cross each other. Edges that only touch do not cross. */
bool hl_polygon_crosses_itself(const polygon_shape *shape, const double (*vertices)[3], size_t count);

/* The plane of a light's emission image. Positions in this plane are offsets from the light's centre; for
 * parallel light, offsets at distance 1 from the direction to the light. */
typedef struct emission_plane {
  vec3 middle;    /* the middle of the image */
  vec3 right, up; /* vectors from `middle` to the middles of the image's right and top edges */
} emission_plane;

/* Finds unit vectors to the right and upwards, as seen by someone who looks against a unit normal. */
void hl_upright(vec3 normal, vec3 wanted_up, vec3 *right, vec3 *up);

/* The image coordinates of an offset in the plane: s along right and t along up, each from -1 to 1 within the
 * image. */
void hl_emission_place(const emission_plane *plane, vec3 offset, double *s, double *t);

/* ---- disks; normal: unit ---- */

/* The offset, from a disk's centre, of the point of the disk that belongs to the point (a, b) of the unit
 * square. Parts of the square that have equal areas become parts of the disk that have equal areas. */
vec3 hl_disk_point(vec3 normal, double radius, double a, double b);
mat3 hl_disk_spread(vec3 normal, double radius);
/* The plane of an emission image that fills the square around a disk. */
emission_plane hl_disk_plane(vec3 normal, double radius, vec3 wanted_up);

/* ---- second moments ---- */

mat3 hl_outer(vec3 a, vec3 b); /* the outer product a b', a matrix */
mat3 hl_add_scaled(mat3 a, mat3 b, double scale);

#endif
