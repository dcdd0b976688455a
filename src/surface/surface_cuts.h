/* surface/surface_cuts.h - finds the samples of pixels at which a mesh is seen, where the scene's cuts remove
 * parts of the mesh. */
#ifndef HL_SURFACE_SURFACE_CUTS_H
#define HL_SURFACE_SURFACE_CUTS_H

#include "surface/fragment.h"
#include "surface/surface_plane.h"

/* The part of a primitive that a view sees: a triangle, or one side of a sphere. All members are borrowed. */
typedef struct seen_part {
  const surfaces *all;                                  /* the surfaces, whose cuts are applied; null if no
                                                         * cut removes anything of the part */
  vec3 (*point)(const void *shape, double u, double v); /* a function that finds the part's point at the
                                                         * position (u, v) of the view, in pixels; frame
                                                         * space */
  const void *shape;                                    /* the first argument of `point`: the plane or the
                                                         * sphere */
} seen_part;

/* The answers to the question which part of a primitive the cuts of a mesh leave. */
typedef enum cut_answer { CUT_LEAVES_ALL, CUT_LEAVES_SOME, CUT_LEAVES_NOTHING } cut_answer;
cut_answer hl_surface_cut(const surfaces *all, const surface_mesh *mesh, uint32_t primitive);

/* Returns the given samples of pixel (x, y) at which the scene's cuts do not remove the part. */
uint16_t hl_left_samples(const seen_part *part, int x, int y, uint16_t samples);

#endif
