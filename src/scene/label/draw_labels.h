/* scene/label/draw_labels.h - turns label maps into volumes that can be rendered: a volume of smooth
 * occupancy for all solid labels, and one for each translucent label. */
#ifndef HL_SCENE_LABEL_DRAW_LABELS_H
#define HL_SCENE_LABEL_DRAW_LABELS_H

#include <halflight/scene.h>

#include "core/error.h"
#include "volume/volume.h"

/* Chooses the kernel for a volume. of_scene: the scene's kernel. The voxels of an occupancy, and the bricks
 * of a field, are coefficients of the B-spline already. The interpolating kernel would make coefficients of
 * these coefficients once more, so the B-spline replaces this kernel. */
static inline hl_kernel hl_kernel_of_volume(const hl_scene_volume *volume, hl_kernel of_scene) {
  bool has_coefficients = volume->volume->surface_slope > 0 || volume->volume->bricks != NULL;
  return has_coefficients && of_scene == HL_KERNEL_INTERPOLATING ? HL_KERNEL_BSPLINE : of_scene;
}

/* The volumes that draw a scene's label maps, masks, and walls of meshes of cells; all members are null if
 * the scene has no label map, no mask and no wall. */
typedef struct drawn_labels {
  hl_scene_volume *volumes; /* owned, with a reference to each volume and lattice; the placed description has
                             * this array as its list of volumes */
  void *points;             /* owned; the points of the volumes' transfer functions */
} drawn_labels;

/* Makes a transfer function over the values of a label map: each visible label shows in its colour, for
 * values from half a number below the label to half a number above it. Framing, exposure and legends use this
 * function. The caller owns the function's points (hl_transfer_function_release). */
hl_status hl_labels_function(hl_context *context, const hl_scene_volume *volume,
                             hl_transfer_function *function, hl_error *error);

/* In a placed description, replaces label maps by volumes of occupancy, and masks by lattices (label/mask.h).
 * `drawn` owns the new volumes and lattices, and also the array of volumes that the description then has. In
 * a scene without label maps, masks and walls of cells, the function changes nothing. Call
 * hl_drawn_labels_release() even after a failure. */
hl_status hl_labels_draw(hl_context *context, hl_scene_description *placed, drawn_labels *drawn,
                         hl_error *error);
/* Releases what hl_labels_draw() made. placed: the description that hl_labels_draw() changed. */
void hl_drawn_labels_release(hl_context *context, const hl_scene_description *placed, drawn_labels *drawn);

#endif
