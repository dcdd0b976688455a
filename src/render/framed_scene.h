/* render/framed_scene.h - a scene in frame space: moved to the middle of its volumes, measured in its
 * smallest voxels.
 *
 * Floats are then precise enough wherever the scene lies and whatever its unit of length is. The unit is a
 * power of two, so that scaling rounds nothing: a scene 2^k times as large gives the same bytes. */
#ifndef HL_RENDER_FRAMED_SCENE_H
#define HL_RENDER_FRAMED_SCENE_H

#include "core/error.h"
#include "scene/scene.h"

typedef struct framed_scene {
  hl_scene_description
      scene; /* in frame space; voxels, images and texts are borrowed from the scene in the world */
  hl_scene_volume *volumes; /* owned; [volume_count] */
  hl_light *lights;         /* owned; [light_count] */
  double (*vertices)[3];    /* owned; of all polygons */
  double unit;              /* world length of 1 in frame space: the smallest voxel edge is from 1 to 2 */
} framed_scene;

hl_status hl_framed_scene_create(hl_context *context, const hl_scene_description *scene, framed_scene *framed,
                                 hl_error *error);
void hl_framed_scene_release(hl_context *context, framed_scene *framed);

#endif
