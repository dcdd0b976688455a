/* halflight/preview.h - quick pictures while a camera, a light or a colour moves: the scene is rendered with
 * coarser copies of its volumes.
 *
 * The time of a picture grows with its number of pixels times its number of sheets. Fewer sheets alone,
 * farther apart, would miss what lies between them, so that thin surfaces break up. So a preview has copies
 * of the volumes in which 2, 4 or 8 voxels along each axis are merged. For a scene, the preview takes the
 * copies whose voxels are about as long as the distance between the scene's sheets. examples/c/preview.c is a
 * loop that turns a volume at an interactive rate. */
#ifndef HALFLIGHT_PREVIEW_H
#define HALFLIGHT_PREVIEW_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Coarser copies of a scene's volumes. Any number of threads may use it at once. */
typedef struct hl_preview hl_preview;

/* Makes the coarser copies of the scene's volumes and masks, which takes one pass over their voxels and a
 * seventh of their memory. It may run in a thread of its own while the scene is rendered. In copies of label
 * maps and masks, a voxel has the label that most of the merged voxels have. These volumes get no copies:
 * volumes with colours, volumes over ranks, volumes of fewer than 64^3 voxels, and label maps with labels
 * beyond 2^24, which floats would round. The copies suit the way in which this scene uses the volume, as a
 * label map or as values. Errors: HL_ERROR_MEMORY; HL_ERROR_CANCELLED. */
HL_API HL_WARN_UNUSED hl_status hl_preview_create(hl_context *context, const hl_scene *scene,
                                                  hl_preview **preview, hl_error *error);
HL_API void hl_preview_destroy(hl_preview *preview); /* null is allowed */

/* The scene as it is rendered while something moves: each volume or mask that the preview has copies of is
 * replaced by the coarsest copy whose shortest voxel edge is at most the square root of 2 times the distance
 * of the scene's sheets. Copies for another use of a volume of the preview, as
 * a label map or as values, are made by the first call with a scene that uses the volume so; where memory is
 * short for them, the volume stays as it is. render.sheet_spacing is written anew in the voxels of the
 * copies, so that the sheets stay as far apart as they were. Everything else stays. *quick is the scene
 * itself, retained, where no copy is that coarse. Use a renderer for such scenes alone: a renderer prepares a
 * volume anew when the volume changes. */
HL_API HL_WARN_UNUSED hl_status hl_preview_scene(hl_preview *preview, hl_scene *scene, hl_scene **quick,
                                                 hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
