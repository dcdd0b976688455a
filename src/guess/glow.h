/* guess/glow.h - estimates the scattered light within a medium that scatters light again and again, at the
 * cells of a coarse grid. */
#ifndef HL_GUESS_GLOW_H
#define HL_GUESS_GLOW_H

#include "core/context.h"
#include "core/error.h"
#include "core/vector.h"

enum { HL_GLOW_MOST_LIGHTS = 4 };

/* Matter at a place: its extinction, and the part of the extinction that scatters light; per world unit. */
typedef struct hl_glow_matter {
  double extinction, scattering;
} hl_glow_matter;

typedef struct hl_glow_request {
  double low[3], high[3]; /* the medium's box in index space */
  affine3 index_to_world;
  hl_glow_matter (*matter)(const void *data, vec3 place); /* place: in index space */
  const void *data;
  double anisotropy;
  vec3 towards[HL_GLOW_MOST_LIGHTS];    /* [light_count]; unit vectors of the world to the lights */
  double strength[HL_GLOW_MOST_LIGHTS]; /* [light_count]; the lights' strengths */
  size_t light_count;
  double sky; /* the mean radiance of the sky */
} hl_glow_request;

/* The estimated light. hl_glow_release() releases it, and accepts an empty struct. */
typedef struct hl_glow {
  int count[3];
  double low[3], size[3]; /* the grid's corner and the size of a cell, in index space */
  double *light; /* owned; [count[2]][count[1]][count[0]]; the mean over all directions of scattered light and
                    of the sky's light */
} hl_glow;

hl_status hl_glow_make(hl_context *context, const hl_glow_request *request, hl_glow *glow, hl_error *error);
void hl_glow_release(hl_context *context, hl_glow *glow);

/* The light at a place in index space, interpolated between the cells' centres. */
double hl_glow_at(const hl_glow *glow, vec3 place);

#endif
