/* scene/label/draw_labels.h - turns label maps into volumes that can be rendered: a volume of smooth
 * occupancy for each label that shows. */
#ifndef HL_SCENE_LABEL_DRAW_LABELS_H
#define HL_SCENE_LABEL_DRAW_LABELS_H

#include <halflight/scene.h>

#include "core/error.h"
#include "volume/volume.h"

/* The kernel for a volume in a scene with this kernel. The voxels of an occupancy, and the bricks of a field,
 * are coefficients of the B-spline already, and not values through which it should pass. */
static inline hl_kernel hl_kernel_of_volume(const hl_scene_volume *volume, hl_kernel of_scene) {
  bool has_coefficients = volume->volume->surface_slope > 0 || volume->volume->bricks != NULL;
  return has_coefficients && of_scene == HL_KERNEL_INTERPOLATING ? HL_KERNEL_BSPLINE : of_scene;
}

/* The volumes that draw a scene's label maps; all null where there are neither label maps nor masks. */
typedef struct drawn_labels {
  hl_scene_volume *volumes; /* owned, with a reference to each volume and lattice; the placed description's
                             * list of volumes is this array */
  void *points;             /* owned; the points of the volumes' transfer functions */
} drawn_labels;

/* A transfer function over a label map's own values: it shows each visible label, from half a number below it
 * to half a number above it, in its colour. Framing, exposure and legends use it. function's points are owned
 * by the caller (hl_transfer_function_release). */
hl_status hl_labels_function(hl_context *context, const hl_scene_volume *volume,
                             hl_transfer_function *function, hl_error *error);

/* Replaces the label maps of a placed description by volumes of occupancy, and the volumes of masks by
 * lattices (label/mask.h), all of which `drawn` owns. The description then has the array of volumes of
 * `drawn`. Nothing happens where there are neither label maps nor masks. After a failure, too, call
 * hl_drawn_labels_release(). */
hl_status hl_labels_draw(hl_context *context, hl_scene_description *placed, drawn_labels *drawn,
                         hl_error *error);
/* Releases what hl_labels_draw() made. placed: the description that hl_labels_draw() changed. */
void hl_drawn_labels_release(hl_context *context, const hl_scene_description *placed, drawn_labels *drawn);

#endif
