/* surface/triangle_bins.h - triangles as one view sees them, sorted by the tiles that they touch.
 *
 * A triangle that crosses the view's eye is cut there, and one that reaches far outside the view is cut to a
 * frame around it, so that whole numbers hold all pixel coordinates. */
#ifndef HL_SURFACE_TRIANGLE_BINS_H
#define HL_SURFACE_TRIANGLE_BINS_H

#include "core/pool.h"
#include "surface/surfaces.h"
#include "view/view.h"

enum { SUBPIXELS = 256, CLIPPED_CORNERS = 8 };

/* A triangle in a view: a polygon of three corners, or more where it was cut. */
typedef struct seen_polygon {
  int count;                                      /* 0: nothing is seen */
  int32_t x[CLIPPED_CORNERS], y[CLIPPED_CORNERS]; /* 1/256 pixels */
} seen_polygon;

void hl_see_triangle(const view *view, const surfaces *all, uint32_t triangle, seen_polygon *polygon);

typedef struct triangle_bins {
  uint32_t *first;     /* owned; [tiles + 1] */
  uint32_t *triangles; /* owned; by tile, then in their order */
} triangle_bins;

/* wanted: [mesh_count]; the meshes whose triangles are binned. */
hl_status hl_triangle_bins_create(hl_context *context, hl_pool *pool, const surfaces *all, const view *view,
                                  const bool *wanted, triangle_bins *bins, hl_error *error);
void hl_triangle_bins_release(hl_context *context, triangle_bins *bins);

#endif
