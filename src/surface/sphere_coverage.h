/* surface/sphere_coverage.h - which samples of a tile's pixels a sphere covers, and where rays meet it. */
#ifndef HL_SURFACE_SPHERE_COVERAGE_H
#define HL_SURFACE_SPHERE_COVERAGE_H

#include "surface/coverage.h"

/* Finds the samples of a tile that a sphere covers, as hl_cover_tile() does for polygons. The view sees the
 * sphere within the given bounds. */
bool hl_cover_sphere(const view *view, const float sphere[4], const seen_bounds *bounds, int tile_x,
                     int tile_y, pixel_span *span, uint16_t covered[TILE_PIXELS]);

/* The ray A + s B of a pixel, counted from the sphere's centre. Both vectors are linear in the pixel. */
typedef struct sphere_rays {
  vec3 start, start_u, start_v, way, way_u, way_v, centre;
  double radius;
  bool perspective;
} sphere_rays;

sphere_rays hl_sphere_rays(const view *view, const float sphere[4]);

/* Finds where the ray of the continuous pixel (u, v) enters and leaves a sphere. For a ray that misses the
 * sphere, both places are the sphere's point nearest to the ray. False where the point lies behind a
 * perspective view's eye. */
bool hl_meet_sphere(const sphere_rays *rays, double u, double v, bool leaving, vec3 *point);

#endif
