/* surface/small_triangles.h - finds the samples that small triangles cover, and their heights there, for
 * sixteen triangles at a time.
 *
 * A triangle is small if its box touches at most four by four pixels of a view, and its height changes by at
 * most four distances of sheets. The height between its corners is then nearly linear in the pixel, even in
 * perspective views. For other triangles coverage.h and surface_plane.h are used. */
#ifndef HL_SURFACE_SMALL_TRIANGLES_H
#define HL_SURFACE_SMALL_TRIANGLES_H

#include <stddef.h>
#include <stdint.h>

#include "surface/late/lateness.h"
#include "view/view.h"

enum { SMALL_TRIANGLES = 16, SMALL_SIDE = 4, SMALL_PIXELS = SMALL_SIDE * SMALL_SIDE };

/* A view, and the data by which fragments of one mesh are placed in it. Vectors are in frame space. */
typedef struct small_view {
  float normal[3], first; /* the sheets' normal; a point's height is normal.X - first */
  float spacing, last_slab;
  int32_t columns, rows; /* number of the tile's columns and rows that lie within the view */
  int of_light;          /* not 0 if the view is a light's; in other views the members from `perspective` to
                          * `rise` are not used */
  int perspective;       /* not 0 if the rays come from the point `from`; if 0, they run along the vector
                          * `from` */
  float from[3], du[3], dv[3];
  float depth[3];    /* in a perspective view: the vector that gives the distance of a point X from the eye,
                      * depth.(X - from). The unit is the length of the ray's direction vector */
  float delay, rise; /* the members delay and rise of fragments_source, in pixels */
  double inverse[3][3], origin[3]; /* for clusters: the rows of `inverse`, multiplied by (point - origin),
                                    * give w, w u and w v; in a parallel view w is 1 instead */
  int32_t left, top;               /* for clusters: the coordinates of the tile's corner; 1/256 pixels */
  const view *view;                /* the view, used for spheres only; borrowed */
  const sheet_stack *sheets;       /* the sheets, used for spheres only; borrowed */
  int fronts;                      /* whether only triangles whose fronts face the view are covered */
  /* only in a light's view: whether the mesh's back sides get no light. Fragments at which the light's rays
   * leave the mesh then have no delay */
  int dark_backs;
} small_view;

typedef struct small_triangles {
  /* the corners, in 1/256 pixels from the tile's corner */
  _Alignas(64) int32_t x[3][SMALL_TRIANGLES], y[3][SMALL_TRIANGLES];
  float height[3][SMALL_TRIANGLES]; /* heights of the corners above the first sheet: normal.X - first for
                                     * the corner X */
  float normal[3][SMALL_TRIANGLES]; /* for a light's view: the cross product of each triangle's sides, from
                                     * hl_corner_product() */
  float corner[3][SMALL_TRIANGLES]; /* for a light's perspective view: the triangles' first corners; frame
                                     * space */
} small_triangles;

/* The cross product of a triangle's sides; frame space. */
static inline void hl_corner_product(const float *const corner[3], float normal[3]) {
  float a[3], b[3];
  for (int axis = 0; axis < 3; axis++) {
    a[axis] = corner[1][axis] - corner[0][axis];
    b[axis] = corner[2][axis] - corner[0][axis];
  }
  for (int axis = 0; axis < 3; axis++) {
    int next = (axis + 1) % 3, last = (axis + 2) % 3;
    normal[axis] = a[next] * b[last] - a[last] * b[next];
  }
}

/* The triangles of a cluster. Each array has one column for each triangle. */
enum { CLUSTER_TRIANGLES = 64, CLUSTER_VERTICES = 3 * CLUSTER_TRIANGLES };
typedef struct cluster_shape {
  const float *positions; /* [3][vertices]; the positions of the vertices, axis by axis; frame space */
  size_t vertices;        /* number of vertices, a multiple of 16; the last vertices may repeat others */
  const uint8_t (*corners)[CLUSTER_TRIANGLES]; /* [3]; for each corner of each triangle, the index of its
                                                * vertex */
  const float (*normals)[CLUSTER_TRIANGLES];   /* [3]; the cross product of each triangle's sides, from
                                                * hl_corner_product(); axis by axis */
} cluster_shape;

/* The places at which a view sees the vertices of a cluster in which no triangle is cut. */
typedef struct seen_cluster {
  _Alignas(64) int32_t x[CLUSTER_VERTICES], y[CLUSTER_VERTICES]; /* the vertices' places in the view; 1/256
                                                                  * pixels */
  float height[CLUSTER_VERTICES];                                /* the vertices' heights above the first
                                                                  * sheet, frame units */
} seen_cluster;

/* The samples that sixteen small triangles cover. Pixel k of a triangle is the pixel k % SMALL_SIDE columns
 * and k / SMALL_SIDE rows from the first pixel of the triangle's box. */
typedef struct small_cover {
  uint32_t large; /* the triangles that touch the tile but are too large for this function, one bit each */
  uint32_t covered[SMALL_PIXELS]; /* for each pixel, the triangles that cover some of its samples, one bit
                                   * each; the members below are set only where a pixel and a triangle have
                                   * such a bit */
  /* the number of each pixel in the tile, block after block: 16 * block + lane */
  _Alignas(64) int32_t pixel[SMALL_PIXELS][SMALL_TRIANGLES];
  uint16_t samples[SMALL_PIXELS][SMALL_TRIANGLES]; /* covered samples, one bit each */
  int32_t reach[SMALL_PIXELS][SMALL_TRIANGLES];    /* for the eye's view: the reaches of the fragments */
  float height[SMALL_PIXELS][SMALL_TRIANGLES];     /* the height above the first sheet, in the middle of the
                                                    * covered samples */
  float start[SMALL_PIXELS][SMALL_TRIANGLES];      /* for a light's view: the height from which on the
                                                    * fragment absorbs light */
  int32_t slab[SMALL_PIXELS][SMALL_TRIANGLES];     /* the slab that holds `height` */
  int32_t first_slab[SMALL_PIXELS][SMALL_TRIANGLES],
      last_slab[SMALL_PIXELS][SMALL_TRIANGLES]; /* for a light's view: the last slab that the fragment
                                                 * fills */
} small_cover;

/* Finds the samples that small triangles cover. Returns which triangles are small, one bit each; other
 * triangles are left out. */
typedef uint32_t cover_small_function(const small_view *view, const small_triangles *triangles,
                                      small_cover *cover);

typedef void see_cluster_function(const small_view *view, const cluster_shape *shape, seen_cluster *seen);

/* The type of the function that does the work of cover_small_function for sixteen triangles of a cluster,
 * `first` to first + 15. wanted: the triangles that are looked at, one bit each. */
typedef uint32_t cover_cluster_function(const small_view *view, const cluster_shape *shape,
                                        const seen_cluster *seen, int first, uint32_t wanted,
                                        small_cover *cover);

/* Sixteen spheres that no cut touches and that let no light pass. */
typedef struct small_spheres {
  _Alignas(64) float centre[3][SMALL_TRIANGLES], radius[SMALL_TRIANGLES]; /* centres and radii in frame
                                                                           * space */
} small_spheres;

/* The type of the function that does the work of cover_small_function for sixteen spheres. A sphere is small
 * if its box touches at most four by four pixels of the tile, and if the view sees it from outside. The
 * function must not be used for views of lights whose fragments fill several slabs. */
typedef uint32_t cover_spheres_function(const small_view *view, const small_spheres *spheres,
                                        small_cover *cover);

/* The functions of the folder surface of which each instruction set has a compiled version. */
typedef struct surface_functions {
  cover_small_function *cover_small;
  see_cluster_function *see_cluster;
  cover_cluster_function *cover_cluster;
  cover_spheres_function *cover_spheres;
} surface_functions;

#endif
