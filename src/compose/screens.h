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
  affine3 to_mask;                 /* the volume's index space to that of its mask, if it has one */
  double step;                     /* world units */
  double opacity[HL_SCREEN_TABLE]; /* of a step; entries over the volume's range */
} hl_screen;

/* Whether all voxels of a volume are in memory. Voxels here and there of a scratch file, or of other
 * processes, would take too long. */
bool hl_is_at_hand(const hl_volume *volume);

/* Whether a volume can hide things as far as can be told here: it shows values by their opacity alone. */
bool hl_screen_can_hide(const hl_scene_volume *volume);

/* Begins a screen of a volume, which is released even after a failure. A label map has cuts, but no
 * opacities. */
hl_status hl_screen_begin(hl_context *context, const hl_scene_description *scene,
                          const hl_scene_volume *volume, hl_screen *screen, hl_error *error);
void hl_screen_release(hl_context *context, hl_screen *screen);

/* Whether the clip box, the cuts and the mask leave a volume's matter at a place in its index space. */
bool hl_screen_leaves(const hl_screen *screen, vec3 place);

/* The index of the label of a map that a value is, if the label is visible; the number of labels if there is
 * no such label. */
size_t hl_screen_label(const hl_scene_volume *map, double value);

/* Whether a visible label faces a side: whether a step from its place, in the index space of its map, leads
 * out of the map's visible labels. towards: a unit vector of the world. */
bool hl_screen_label_faces(const hl_screen *map, vec3 place, vec3 towards);

/* The opacity of a step within matter of a value; 0 for values that are not finite. */
double hl_screen_opacity(const hl_screen *screen, double value);

/* The fraction of the light that passes a volume on its way from a point of the world. towards: a unit
 * vector. Fractions below `least` are not found exactly. */
double hl_screen_passing(const hl_screen *screen, vec3 point, vec3 towards, double least);

/* The number of voxels that are examined in a volume of `all` voxels, and the examined voxel number n. Steps
 * of about the golden section reach evenly distributed voxels. */
uint64_t hl_examined_voxels(uint64_t all);
uint64_t hl_examined_voxel(uint64_t n, uint64_t all);

#endif
