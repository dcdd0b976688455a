/* guess/outline.h - the outermost points of what is seen of a scene: all that framing it needs to know. */
#ifndef HL_GUESS_OUTLINE_H
#define HL_GUESS_OUTLINE_H

#include "scene/scene.h"

/* Balls: a voxel's half diagonal about its centre. The greatest of what they reach in any direction, in
 * perspective too, is the greatest of all voxels that are seen. */
typedef struct hl_outline {
  hl_context *context;
  vec3 *point;    /* owned; [count]; world */
  double *radius; /* owned; [count] */
  size_t count, capacity;
} hl_outline;

/* Of all visible volumes; where nothing is seen of any, the corners of all volumes' boxes. Fails for lack of
 * memory alone; release in any case. description has a volume at least. */
hl_status hl_outline_find(const hl_scene_description *description, hl_outline *outline, hl_error *error);
void hl_outline_release(hl_outline *outline);

/* *thinned: the points that reach farthest in some hundred directions, which tell of any other to half a per
 * cent of the whole. */
hl_status hl_outline_thin(const hl_outline *outline, hl_outline *thinned, hl_error *error);

/* The greatest of p . along - tangent p . forward over all points of all balls; along is perpendicular to
 * forward. */
double hl_outline_reach(const hl_outline *outline, vec3 along, vec3 forward, double tangent);

#endif
