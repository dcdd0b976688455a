/* scene/geometry/placement.h - finds the maps from volumes and meshes to the world, the boxes around them,
 * and the frame space of a scene. */
#ifndef HL_SCENE_GEOMETRY_PLACEMENT_H
#define HL_SCENE_GEOMETRY_PLACEMENT_H

#include <halflight/scene.h>

#include "scene/light/suns.h"
#include "volume/volume.h"

/* The volume's scale along x, y or z (axis 0 to 2) of the world of its file. */
double hl_scene_volume_scale(const hl_scene_volume *volume, int axis);

/* The map from the world of the volume's file to the scene's world: scale, rotation, translation. */
affine3 hl_scene_volume_file_to_world(const hl_scene_volume *volume);

/* The map from a volume's index space to the world: the volume's own placement, then scale, rotation,
 * translation. */
affine3 hl_scene_volume_index_to_world(const hl_scene_volume *volume);

/* The map from the index space of the volume's mask to the world: the mask's own placement, then the volume's
 * scale, rotation and translation. */
affine3 hl_scene_mask_index_to_world(const hl_scene_volume *volume);

/* The map from a mesh's own space to the world: scale, rotation, translation. */
affine3 hl_scene_mesh_to_world(const hl_scene_mesh *mesh);

/* The box that the volume fills in its own index space: from -0.5 to n - 0.5 along each axis, cut down to the
 * clip box. The clip box lies in the world of the volume's file. If the grid is oblique to the clip box, the
 * bounds of the clip box in index space take the place of the clip box. */
void hl_scene_volume_box(const hl_scene_volume *volume, double low[3], double high[3]);

/* The shortest edge of any voxel of the scene's volumes. In a scene without volumes, the result is a 200th of
 * the longest side of the box around all meshes. */
double hl_scene_smallest_edge(const hl_scene_description *scene);

/* Finds the box, in the world, around all volumes of a scene, cut down to their clip boxes. In a scene
 * without volumes, finds the box around all meshes. */
void hl_scene_content_box(const hl_scene_description *scene, vec3 *low, vec3 *high);

/* Frame space, in which a scene is rendered: p -> (p - centre) / unit. centre is the middle of the box around
 * all volumes or, in a scene without volumes, around all meshes. unit is a power of two: the smallest voxel
 * edge is 1 to 2 units long. */
typedef struct hl_frame_space {
  vec3 centre;
  double unit;
} hl_frame_space;

/* A light with falloff gets no brighter below this distance; frame units. */
#define HL_LEAST_LIGHT_DISTANCE 1e-3

/* Finds the frame space of a scene. The description must have at least one volume or mesh. */
hl_frame_space hl_scene_frame_space(const hl_scene_description *scene);

/* Finds the empty value of a volume: the value of the volume's surroundings, and of voxels that are not
 * finite. If the volume does not tell the value of its surroundings, the empty value is the most frequent
 * transparent value of the voxels. If no value is transparent, the empty value lies below the volume's range,
 * and is treated as transparent. */
double hl_scene_volume_empty_value(const hl_scene_volume *volume);

/* The direction, in the world, in which the light of a directional or spot light travels. */
vec3 hl_light_way(const hl_camera *camera, const hl_light *light);

/* Copies a description. All lights of the copy are in the world, and are followed by the suns of its sky.
 * Images are shared with `from` and `suns`. *to owns the array of lights and the vertices of polygons
 * (hl_placed_lights_release). */
hl_status hl_lights_place(hl_context *context, const hl_scene_description *from, const sky_suns *suns,
                          hl_scene_description *to, hl_error *error);
void hl_placed_lights_release(hl_context *context, hl_scene_description *placed);

/* The first volume of a scene that has a given name; null if no volume has this name. */
const hl_scene_volume *hl_scene_volume_named(const hl_scene_description *scene, const char *name);

#endif
