/* light/light_extent.h - points on an extended light, and how large the sheets see it. */
#ifndef HL_LIGHT_LIGHT_EXTENT_H
#define HL_LIGHT_LIGHT_EXTENT_H

#include "light/light_source.h"

/* Maps the unit square onto the light, equal areas to equal areas; the centre's offset from the light's
 * centre, or for parallel light from its direction (directions are points at distance 1). A sphere is its
 * disk that faces the content. */
vec3 hl_light_point(const light_source *source, double a, double b);

/* sublight_points.c: part (i, j) of side x side parts, its point of the unit square, of any light. A turned
 * grid: one point in each cell, and seen along either side of the square the points are side^2 even steps. */
void hl_sublight_grid_point(int side, int i, int j, double square[2]);

/* The same of that light, where few points do best; not those of cells of the square, as an image's colours
 * are. */
void hl_sublight_point(const light_source *source, int side, int i, int j, double square[2]);

/* The light as the content's middle sees it on a plane parallel to the sheets: through the light's centre, or
 * for parallel light through the end of its direction. */
typedef struct sheet_light {
  vec3 middle; /* of the projection; frame space, or the way from which parallel light comes on average */
  vec3 u, v;   /* unit vectors in the sheets: the projection's principal axes, u the longer */
  double width_u, width_v; /* of the boxes that spread as far; world units, or lengths a unit of height */
  mat3 spread; /* mean of x x' over the light itself, from its centre; along u, v and the sheets' normal */
  bool parallel;
} sheet_light;

sheet_light hl_light_on_sheets(const light_source *source, vec3 normal);

/* Where an offset from the light's centre (hl_light_point) lies, from seen->middle: along u, v and the
 * sheets' normal; of parallel light along u and v a unit of height away. A receiver at a slope sees u and v
 * less by slope times the third. */
void hl_sheet_light_position(const sheet_light *seen, const light_source *source, vec3 normal, vec3 offset,
                             double position[3]);

/* The square of width_u (axis 0) or width_v (1) as seen at a slope from the light: where a receiver lies that
 * many lengths along the axis a length of height below the light. A light tilted against the sheets looks
 * wider from one side. */
double hl_sheet_light_squared_width(const sheet_light *light, int axis, double slope);

/* Section 5.2, (1) and (3): the average size of the light's orthogonal projection onto the sheets. */
double hl_light_average_size(const light_source *source, vec3 normal);

#endif
