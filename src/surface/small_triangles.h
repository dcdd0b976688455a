/* surface/small_triangles.h - sixteen triangles of few pixels at a time: what they cover, and at which
 * height.
 *
 * A triangle is small where its box touches at most four by four pixels of a view and its height changes by
 * at most four distances of sheets: between its corners the height is then as good as linear in the pixel, in
 * perspective views too. Other triangles are left to coverage.h and surface_plane.h. */
#ifndef HL_SURFACE_SMALL_TRIANGLES_H
#define HL_SURFACE_SMALL_TRIANGLES_H

#include <stdint.h>

enum { SMALL_TRIANGLES = 16, SMALL_SIDE = 4, SMALL_PIXELS = SMALL_SIDE * SMALL_SIDE };

/* The surface's slope in frame units a pixel is no steeper: one that light almost grazes would be delayed
 * without end, and it is hardly lit. */
#define STEEPEST_SLOPE 12

/* Distances of sheets by which a fragment's slabs may lie above its triangle: the neighbour's fragment of a
 * pixel on their edge lies beyond it, and both must fill one slab for the pixel to be full there. */
#define SEAM 2

/* The least delay, in distances of sheets: a surface along the sheets must not come to lie in an earlier slab
 * in the light's view than in the eye's, for rounding. */
#define LEAST_DELAY 0.02

/* A view, and how the fragments of one mesh enter it. Vectors in frame space. */
typedef struct small_view {
  float normal[3], first; /* of the sheets: a point's height is normal.X - first */
  float spacing, last_slab;
  int32_t columns, rows; /* of the tile, within the view */
  int of_light;          /* else the members below are not used */
  int perspective;       /* the rays come from `from`; else they go along it */
  float from[3], du[3], dv[3];
  float depth[3];    /* perspective: a point's distance in lengths of its ray is depth.(X - from) */
  float delay, rise; /* as in fragments_source */
  int dark_backs;    /* as in fragment_work: where the rays leave the mesh there is no delay */
} small_view;

typedef struct small_triangles {
  _Alignas(64) int32_t x[3][SMALL_TRIANGLES], y[3][SMALL_TRIANGLES]; /* corners; 1/256 pixels
 from the tile's */
  float position[3][3][SMALL_TRIANGLES];                             /* corners; frame space; axis by axis */
} small_triangles;

/* Pixel k of a triangle is k % SMALL_SIDE columns and k / SMALL_SIDE rows from the first pixel of its box. */
typedef struct small_cover {
  uint32_t covered[SMALL_PIXELS]; /* the triangles that cover samples of it, one bit each; for others the rest
                                     is not set */
  _Alignas(64) int32_t pixel[SMALL_PIXELS][SMALL_TRIANGLES]; /* its number in the tile, block after block */
  uint16_t samples[SMALL_PIXELS][SMALL_TRIANGLES];           /* covered, one bit each */
  int32_t reach[SMALL_TRIANGLES];                            /* of the eye's view: of the fragments */
  float height[SMALL_PIXELS][SMALL_TRIANGLES]; /* in the middle of the samples; above the first sheet */
  float start[SMALL_PIXELS][SMALL_TRIANGLES];  /* of a light's view: the delayed height */
  int32_t slab[SMALL_PIXELS][SMALL_TRIANGLES]; /* of the height */
  int32_t first_slab[SMALL_PIXELS][SMALL_TRIANGLES],
      last_slab[SMALL_PIXELS][SMALL_TRIANGLES]; /* of a light's
                                                   view: filled */
} small_cover;

/* Returns which triangles are small, one bit each; the others are not covered. */
typedef uint32_t cover_small_function(const small_view *view, const small_triangles *triangles,
                                      small_cover *cover);

/* The room's functions that are compiled for each instruction set. */
typedef struct surface_functions {
  cover_small_function *cover_small;
} surface_functions;

#endif
