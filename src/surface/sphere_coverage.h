/* surface/sphere_coverage.h - finds the samples of a tile's pixels that a sphere covers, and the points where
 * rays meet the sphere. */
#ifndef HL_SURFACE_SPHERE_COVERAGE_H
#define HL_SURFACE_SPHERE_COVERAGE_H

#include "surface/coverage.h"

/* Finds the samples of a tile that a sphere covers, as hl_cover_tile() does for polygons. bounds: a rectangle
 * around the part of the sphere that the view sees. */
bool hl_cover_sphere(const view *view, const float sphere[4], const seen_bounds *bounds, int tile_x,
                     int tile_y, pixel_span *span, uint16_t covered[TILE_PIXELS]);

/* The ray A + s B of a pixel, relative to the sphere's centre. The vectors A and B are linear functions of
 * the pixel. */
typedef struct sphere_rays {
  vec3 start, start_u, start_v, way, way_u, way_v, centre;
  double radius;
  bool perspective;
} sphere_rays;

sphere_rays hl_sphere_rays(const view *view, const float sphere[4]);

/* Finds the point where a ray enters a sphere or, if `leaving` is set, the point where the ray leaves the
 * sphere. (u, v): the ray's position in the picture, in pixels. If the ray misses the sphere, both places
 * are the point of the sphere nearest to the ray. Returns false if the point lies behind a perspective
 * view's eye. */
bool hl_meet_sphere(const sphere_rays *rays, double u, double v, bool leaving, vec3 *point);

#endif
