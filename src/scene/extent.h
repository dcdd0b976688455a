/* scene/extent.h - how far what is visible of a scene reaches, seen along a fixed direction.
 *
 * Each side of a picture is a plane through the eye, so the nearest eye that has every visible voxel inside all four
 * planes follows from four maxima over the voxels. Of each row of voxels only the first and the last visible one can be
 * extreme. */
#ifndef HL_SCENE_EXTENT_H
#define HL_SCENE_EXTENT_H

#include "scene/scene.h"

/* What reaches farthest: x - z tx, -x - z tx, y - z ty, -y - z ty, z and -z; x, y, z are world units along right, up and
 * forward. */
enum { EXTENT_LEFT, EXTENT_RIGHT, EXTENT_BOTTOM, EXTENT_TOP, EXTENT_FAR, EXTENT_NEAR, EXTENT_BOUNDS };

typedef struct extent {
  vec3 right, up, forward;      /* unit, world */
  double tangent_x, tangent_y;  /* half the picture's width and height at distance 1; 0: parallel */
  double bound[EXTENT_BOUNDS];  /* greatest of all that is visible; -infinity before anything is */
} extent;

/* Raises the bounds by the visible voxels of all volumes; where nothing is visible, by the volumes' boxes. */
void hl_extent_add_scene(extent *extent, const hl_scene_description *description);

#endif
