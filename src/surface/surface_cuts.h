/* surface/surface_cuts.h - which samples of pixels see a part of a mesh that the scene's cuts have not
 * removed. */
#ifndef HL_SURFACE_SURFACE_CUTS_H
#define HL_SURFACE_SURFACE_CUTS_H

#include "surface/fragment.h"
#include "surface/surface_plane.h"

/* The part of a primitive that a view sees: a triangle, or one side of a sphere. All members are borrowed. */
typedef struct seen_part {
  const surfaces *all;                                  /* null: cuts leave all of it */
  vec3 (*point)(const void *shape, double u, double v); /* of the part, at a continuous pixel; frame space */
  const void *shape;                                    /* the function's own */
} seen_part;

/* What the cuts leave of a primitive of a mesh. */
typedef enum cut_answer { CUT_LEAVES_ALL, CUT_LEAVES_SOME, CUT_LEAVES_NOTHING } cut_answer;
cut_answer hl_surface_cut(const surfaces *all, const surface_mesh *mesh, uint32_t primitive);

/* Those of the given samples of pixel (x, y) at which cuts leave the part. */
uint16_t hl_left_samples(const seen_part *part, int x, int y, uint16_t samples);

#endif
