/* scene/placement.h - where a scene's volumes and lights are in the world, and the space that it is rendered
 * in. */
#ifndef HL_SCENE_PLACEMENT_H
#define HL_SCENE_PLACEMENT_H

#include <halflight/scene.h>

#include "volume/volume.h"

/* Along x, y or z (0 to 2) of the world of the volume's own file. */
double hl_scene_volume_scale(const hl_scene_volume *volume, int axis);

/* Index space of scene volume -> world: the volume's own placement, then scale, rotate, translate. */
affine3 hl_scene_volume_index_to_world(const hl_scene_volume *volume);

/* The box that the volume fills in its own index space: voxel cells from -0.5 to n-0.5, cut by clip
 * (clip is a box in the file's own world; where the grid is oblique to it, its bounds in index space). */
void hl_scene_volume_box(const hl_scene_volume *volume, double low[3], double high[3]);

/* Frame space, in which a scene is rendered: p -> (p - centre) / unit. centre is the middle of all volumes'
 * boxes, unit the power of two that the smallest voxel edge is 1 to 2 times as long as. */
typedef struct hl_frame_space {
  vec3 centre;
  double unit;
} hl_frame_space;

/* In frame space: closer to its centre no light gets brighter, though it fall with the square of the
 * distance. */
#define HL_LEAST_LIGHT_DISTANCE 1e-3

hl_frame_space hl_scene_frame_space(const hl_scene_description *scene); /* of one volume at least */

/* A value with opacity zero that the volume's surroundings and missing voxels take: the most frequent
 * transparent value; if no value is transparent, one below the volume's range, treated as transparent. */
double hl_scene_volume_empty_value(const hl_scene_volume *volume);

/* The way the light travels, in the world: its direction. */
vec3 hl_light_way(const hl_camera *camera, const hl_light *light);

/* Makes *to the same lights with all of them in the world. Images are shared with from; the array and the
 * vertices of its polygons are owned by *to: hl_placed_lights_release(). */
hl_status hl_lights_place(hl_context *context, const hl_scene_description *from, hl_scene_description *to,
                          hl_error *error);
void hl_placed_lights_release(hl_context *context, hl_scene_description *placed);

#endif
