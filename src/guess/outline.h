/* guess/outline.h - finds the outermost visible voxels of a scene, by which a camera frames the scene. */
#ifndef HL_GUESS_OUTLINE_H
#define HL_GUESS_OUTLINE_H

#include "core/vector.h"
#include "scene/scene.h"

/* Balls around the outermost visible voxels. Their radius is half a voxel's diagonal. In every direction,
 * also in perspective, the balls reach as far as all visible voxels. */
typedef struct hl_outline {
  hl_context *context;
  vec3 *point;    /* owned; [count]; world */
  double *radius; /* owned; [count] */
  size_t count, capacity;
  /* The fraction of the cells in each face of the first volume's grid that hold visible matter, which the
   * face may cut off. Order: the face before the first voxel along x, the face behind the last voxel along x;
   * then the two faces along y and along z. 0 if the scene has no volume. */
  double share[6];
} hl_outline;

/* Finds the outline of all visible volumes and meshes. If nothing is visible, the outline is the corners of
 * all volumes' boxes. Fails only for lack of memory; release the outline even then. description: has at least
 * one volume or mesh. */
hl_status hl_outline_find(const hl_scene_description *description, hl_outline *outline, hl_error *error);
void hl_outline_release(hl_outline *outline);

/* Thins an outline: keeps the points that reach farthest in 400 directions. In any other direction the
 * thinned outline may reach less far than the whole one, by at most half a per cent of the extent. */
hl_status hl_outline_thin(const hl_outline *outline, hl_outline *thinned, hl_error *error);

/* The reach of the outline along a direction: the greatest of p . along - tangent p . forward over all points
 * of all balls. `along` is perpendicular to forward. */
double hl_outline_reach(const hl_outline *outline, vec3 along, vec3 forward, double tangent);

/* The n-th of `count` directions that are spread evenly over the sphere (spherical Fibonacci points; Swinbank
 * and Purser 2006). */
vec3 hl_even_direction(int n, int count);

#endif
