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
  hl_scene_description
      placed; /* the same with all lights in the world: what is rendered; owns its lights' array */
};

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

/* opacity (per unit_distance) and linear colour of a data value: piecewise linear, ends held. */
double hl_transfer_function_opacity(const hl_transfer_function *function, double value);
void hl_transfer_function_color(const hl_transfer_function *function, double value, double color[3]);

/* True if some value in [low, high] has opacity above zero. */
int hl_transfer_function_visible(const hl_transfer_function *function, double low, double high);

/* The transparent value in [low, high] that is nearest to target (inside them); false if there is none. */
bool hl_transfer_function_transparent(const hl_transfer_function *function, double low, double high,
                                      double target, double *nearest);

/* *to gets arrays of its own. */
hl_status hl_transfer_function_copy(hl_context *context, const hl_transfer_function *from,
                                    hl_transfer_function *to, hl_error *error);

/* The camera's unit axes: forward from position to target, up as near to the camera's up as a right angle
 * allows. False if up was useless (along the line of sight): then z, or y where the sight is along z, stands
 * in. */
bool hl_camera_basis(const hl_camera *camera, vec3 *right, vec3 *up, vec3 *forward);

/* The camera that a scene without one gets: a three-quarter view that frames the volumes. Its type and
 * fovy_deg stay. */
hl_status hl_scene_frame(const hl_scene_description *description, hl_camera *camera, hl_error *error);

/* The light that a scene without lights gets: soft, from the upper left of the camera, with which it goes. */
void hl_scene_key_light(hl_light *light);

/* Frees the pixels and file names of a light's texture and emission, where they are owned. */
void hl_light_images_release(hl_context *context, hl_light *light);

/* A value with opacity zero that the volume's surroundings and missing voxels take: the most frequent
 * transparent value; if no value is transparent, one below the volume's range, treated as transparent. */
double hl_scene_volume_empty_value(const hl_scene_volume *volume);

#endif
