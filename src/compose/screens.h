/* compose/screens.h - finds how much light passes the matter of a volume on its way from a place to the eye.
 */
#ifndef HL_COMPOSE_SCREENS_H
#define HL_COMPOSE_SCREENS_H

#include "core/error.h"
#include "core/vector.h"
#include "scene/geometry/cut.h"
#include "scene/geometry/placement.h"
#include "scene/scene.h"

enum { HL_SCREEN_TABLE = 1024 };

/* A place counts as seen if this fraction of its light reaches the eye. */
#define HL_SCREEN_SEEN 0.05

/* A volume whose matter may hide other things. */
typedef struct hl_screen {
  const hl_scene_volume *volume; /* borrowed */
  cut_shape *cuts;               /* owned; the shapes of the volume's own cuts and of its scene's cuts */
  size_t cut_count;
  double low[3], high[3]; /* the volume's box in index space */
  affine3 to_index;
  affine3 to_mask;                 /* maps the volume's index space to the index space of the volume's mask,
                                    * if it has a mask */
  double step;                     /* length of a step, world units */
  double opacity[HL_SCREEN_TABLE]; /* opacity of a step; entries over the volume's range of values */
} hl_screen;

/* Returns whether all voxels of a volume are in memory. Reading scattered voxels from a scratch file, or from
 * other processes, would take too long. */
bool hl_is_at_hand(const hl_volume *volume);

/* Returns whether a volume can hide other things, as far as this file can tell: whether the opacity of its
 * matter depends on values alone, and its voxels are at hand. */
bool hl_screen_can_hide(const hl_scene_volume *volume);

/* Makes the screen of a volume, which the caller releases even after a failure. The screen of a label map has
 * cuts, but no opacities. */
hl_status hl_screen_begin(hl_context *context, const hl_scene_description *scene,
                          const hl_scene_volume *volume, hl_screen *screen, hl_error *error);
void hl_screen_release(hl_context *context, hl_screen *screen);

/* Returns whether the clip box, the cuts and the mask leave a volume's matter at a place in the volume's
 * index space. */
bool hl_screen_leaves(const hl_screen *screen, vec3 place);

/* The index of the map's visible label that has a value; the map's number of labels if no visible label has
 * the value. */
size_t hl_screen_label(const hl_scene_volume *map, double value);

/* Returns whether a visible label faces a direction: whether a step from a place of the label, in the index
 * space of the map, leads out of the map's visible labels. towards: the direction, a unit vector of the
 * world. */
bool hl_screen_label_faces(const hl_screen *map, vec3 place, vec3 towards);

/* The opacity of a step within matter of a value; 0 for values that are not finite. */
double hl_screen_opacity(const hl_screen *screen, double value);

/* The fraction of light that passes a volume's matter on the way from a point of the world. towards: the
 * direction of the way, a unit vector. Fractions below `least` are not found exactly. */
double hl_screen_passing(const hl_screen *screen, vec3 point, vec3 towards, double least);

/* The number of voxels that are examined in a volume of `all` voxels, and the examined voxel number n. Steps
 * of about the golden section reach evenly distributed voxels. */
uint64_t hl_examined_voxels(uint64_t all);
uint64_t hl_examined_voxel(uint64_t n, uint64_t all);

#endif
