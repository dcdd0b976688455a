/* surface/seen.h - triangles and spheres as one view sees them.
 *
 * A triangle that crosses the plane of the view's eye is cut there. A triangle that reaches far outside the
 * view is cut to a frame around the view. Therefore 32-bit whole numbers can hold all coordinates, in 1/256
 * pixels. */
#ifndef HL_SURFACE_SEEN_H
#define HL_SURFACE_SEEN_H

#include "surface/surfaces.h"
#include "view/view.h"

enum { SUBPIXELS = 256, CLIPPED_CORNERS = 8 };

/* A triangle as a view sees it: a polygon of three corners, or of more corners if the triangle was cut. */
typedef struct seen_polygon {
  int count;                                      /* number of corners; if 0, nothing is seen */
  int32_t x[CLIPPED_CORNERS], y[CLIPPED_CORNERS]; /* 1/256 pixels */
} seen_polygon;

/* A view and the surfaces that it sees; borrowed. */
typedef struct seen_surfaces {
  const view *view;
  const surfaces *all;
} seen_surfaces;

/* Finds where the view sees a vertex, in 1/256 pixels. Returns false if the triangles of this vertex may be
 * cut, at the frame or at the eye. */
bool hl_see_vertex(const seen_surfaces *seen, uint32_t vertex, int32_t at[2]);

void hl_see_triangle(const seen_surfaces *seen, uint32_t triangle, seen_polygon *polygon);

/* Twice the area of the triangle of the first three corners of a polygon. It is below 0 if the polygon faces
 * the view. */
static inline int64_t hl_polygon_area(const int32_t *x, const int32_t *y) {
  return (int64_t)(x[1] - x[0]) * (y[2] - y[0]) - (int64_t)(x[2] - x[0]) * (y[1] - y[0]);
}

/* Returns whether a triangle faces the view. A triangle that is seen from its edge counts as facing the
 * view. */
bool hl_faces_view(const seen_surfaces *seen, uint32_t triangle);

/* A rectangle, in pixels with fractions, around the part of a sphere or of a box that a view sees. The
 * functions below return false if the view sees nothing. */
typedef struct seen_bounds {
  double u0, v0, u1, v1;
} seen_bounds;

bool hl_see_sphere(const view *view, const float sphere[4], seen_bounds *bounds);

/* The answers to the question whether a view sees a box of frame space. BOX_UNSEEN: nothing in it is seen.
 * BOX_WHOLE: everything in it is seen within *bounds, and no triangle in it is cut. BOX_CUT: anything else is
 * possible. */
typedef enum seen_box { BOX_UNSEEN, BOX_WHOLE, BOX_CUT } seen_box;
seen_box hl_see_box(const view *view, const float low[3], const float high[3], seen_bounds *bounds);

#endif
