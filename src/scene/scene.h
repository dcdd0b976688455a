/* scene/scene.h - the inside of hl_scene: a checked deep copy of its description. */
#ifndef HL_SCENE_SCENE_H
#define HL_SCENE_SCENE_H

#include <stdatomic.h>

#include <halflight/scene.h>

#include "volume/volume.h"

struct hl_scene {
  hl_context *context;
  atomic_int references;
  hl_scene_description description; /* its arrays and texts are owned by the scene */
};

/* Index space of scene volume -> world: the volume's own placement, then scale, rotate, translate. */
affine3 hl_scene_volume_index_to_world(const hl_scene_volume *volume);

/* The box that the volume fills in its own index space: voxel cells from -0.5 to n-0.5, cut by clip
 * (clip is a box in the file's own world; where the grid is oblique to it, its bounds in index space). */
void hl_scene_volume_box(const hl_scene_volume *volume, double low[3], double high[3]);

/* opacity (per unit_distance) and linear colour of a data value: piecewise linear, ends held. */
double hl_transfer_function_opacity(const hl_transfer_function *function, double value);
void hl_transfer_function_color(const hl_transfer_function *function, double value, double color[3]);

/* True if some value in [low, high] has opacity above zero. */
int hl_transfer_function_visible(const hl_transfer_function *function, double low, double high);

/* A value with opacity zero that the volume's surroundings and missing voxels take: the most frequent
 * transparent value; if no value is transparent, one below the volume's range, treated as transparent. */
double hl_scene_volume_empty_value(const hl_scene_volume *volume);

#endif
