/* surface/seen.h - triangles and spheres as one view sees them.
 *
 * A triangle that crosses the view's eye is cut there, and one that reaches far outside the view is cut to a
 * frame around it, so that whole numbers hold all pixel coordinates. */
#ifndef HL_SURFACE_SEEN_H
#define HL_SURFACE_SEEN_H

#include "core/pool.h"
#include "surface/surfaces.h"
#include "view/view.h"

enum { SUBPIXELS = 256, CLIPPED_CORNERS = 8 };

/* A triangle in a view: a polygon of three corners, or more where it was cut. */
typedef struct seen_polygon {
  int count;                                      /* 0: nothing is seen */
  int32_t x[CLIPPED_CORNERS], y[CLIPPED_CORNERS]; /* 1/256 pixels */
} seen_polygon;

/* Where a view sees the vertices. */
typedef struct seen_vertices {
  const view *view;
  const surfaces *all;
  int32_t (*at)[2]; /* owned; [vertex_count]; 1/256 pixels; x is VERTEX_IS_CUT where the frame or the eye may
                       cut triangles of the vertex */
} seen_vertices;

#define VERTEX_IS_CUT INT32_MIN

hl_status hl_seen_vertices_create(hl_context *context, hl_pool *pool, const surfaces *all, const view *view,
                                  seen_vertices *seen, hl_error *error);
void hl_seen_vertices_release(hl_context *context, seen_vertices *seen);

void hl_see_triangle(const seen_vertices *seen, uint32_t triangle, seen_polygon *polygon);

/* A rectangle around all that a view sees of a sphere; continuous pixels. False: nothing is seen. */
typedef struct seen_bounds {
  double u0, v0, u1, v1;
} seen_bounds;

bool hl_see_sphere(const view *view, const float sphere[4], seen_bounds *bounds);

#endif
