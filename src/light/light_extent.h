/* light/light_extent.h - finds points on an extended light, and the light's size as seen from the sheets. */
#ifndef HL_LIGHT_LIGHT_EXTENT_H
#define HL_LIGHT_LIGHT_EXTENT_H

#include "light/light_source.h"

/* Maps a point of the unit square to a point of the light. Equal areas of the square become equal areas of
 * the light. Returns the point's offset from the light's centre. For parallel light, directions count as
 * points at the distance 1, and the offset is from the light's direction. A sphere counts as the disk through
 * its centre that faces the content. */
vec3 hl_light_point(const light_source *source, double a, double b);

/* The point of the unit square that stands for sub-light (i, j) of side x side sub-lights of any light
 * (sublight_points.c). The points form a turned grid, with one point in each cell of the square. Their
 * projections onto a side of the square have equal distances. */
void hl_sublight_grid_point(int side, int i, int j, double square[2]);

/* Finds the points of the sub-lights of one light. If there are few sub-lights, the points are chosen so that
 * the penumbrae of a light of this shape have the least error. A cell of the unit square may then hold
 * several points or none, so these points do not suit emission images. */
void hl_sublight_point(const light_source *source, int side, int i, int j, double square[2]);

/* The light, as the content's middle sees it, projected onto a plane parallel to the sheets. The plane goes
 * through the light's centre; for parallel light it goes through the end of the light's direction. */
typedef struct sheet_light {
  vec3 middle; /* the middle of the light's projection; frame space; for parallel light the mean direction
                * of travel */
  vec3 u, v;   /* unit vectors within the sheets: the principal axes of the projection; u is the longer
                * axis */
  double width_u, width_v; /* widths, along u and v, of a box that has the same variances as the projection:
                            * frame units; for parallel light, frame units per frame unit of height */
  mat3 spread; /* mean of the matrix x x' over the light. x is the offset of a point of the light from the
                * light's centre, in components along u, v and the sheets' normal */
  bool parallel;
} sheet_light;

sheet_light hl_light_on_sheets(const light_source *source, vec3 normal);

/* Finds the position of a point of the light relative to seen->middle, in coordinates along u, v and the
 * sheets' normal. offset: the point's offset from the light's centre (hl_light_point). For parallel light the
 * first two coordinates are the shift along u and v per unit of height, and the third coordinate is 0. If
 * rays come to a receiver at a slope, the caller must subtract the slope times the third coordinate from the
 * first two. */
void hl_sheet_light_position(const sheet_light *seen, const light_source *source, vec3 normal, vec3 offset,
                             double position[3]);

/* The square of the light's width along u (axis 0) or v (axis 1), as seen by receivers to which rays come at
 * a slope. The slope is the distance along the axis divided by the height below the light. A light that is
 * tilted against the sheets looks wider from one side. */
double hl_sheet_light_squared_width(const sheet_light *light, int axis, double slope);

/* The average size of the light's orthogonal projection onto the sheets (section 5.2, (1) and (3)). */
double hl_light_average_size(const light_source *source, vec3 normal);

#endif
