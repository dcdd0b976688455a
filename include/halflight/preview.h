/* halflight/preview.h - quick pictures while a camera, a light or a colour moves: the same scene, with its
 * volumes at coarser resolutions.
 *
 * A picture costs about its pixels times its sheets. Sheets that are far apart miss what lies between them,
 * and thin surfaces come apart. So a preview has copies of the volumes with voxels merged over 2, 4 or 8
 * along each axis. For a scene it takes the copies whose voxels are about as long as the distance between
 * the scene's sheets. examples/c/preview.c is a loop that turns a volume at an interactive rate. */
#ifndef HALFLIGHT_PREVIEW_H
#define HALFLIGHT_PREVIEW_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Coarser copies of a scene's volumes. It does not change once it is made, and any number of threads may use
 * it. */
typedef struct hl_preview hl_preview;

/* Makes the coarser copies of the scene's volumes and masks, which takes one pass over their voxels and a
 * seventh of their memory. It may run in a thread of its own while the scene is rendered. In copies of
 * label maps and masks a voxel has the label that most of its voxels have. Volumes of colours, volumes over
 * ranks, labels beyond 2^24 that floats round, and volumes of fewer than 64^3 voxels get no copies. The
 * copies of a volume suit its use in this scene: as a label map, or as values. Errors: HL_ERROR_MEMORY;
 * HL_ERROR_CANCELLED. */
HL_API HL_WARN_UNUSED hl_status hl_preview_create(hl_context *context, const hl_scene *scene,
                                                  hl_preview **preview, hl_error *error);
HL_API void hl_preview_destroy(hl_preview *preview); /* null is allowed */

/* The scene as it is rendered while something moves: each volume or mask that the preview has copies of is
 * replaced by the coarsest copy whose shortest voxel edge is at most the square root of 2 times the distance
 * of the scene's sheets. render.sheet_spacing is written anew in the voxels of the copies, so that the sheets
 * stay as far apart as they were. Everything else stays. *quick is the scene itself, retained, where no copy
 * is that coarse. Use a renderer for such scenes alone: a renderer prepares a volume anew when the volume
 * changes. */
HL_API HL_WARN_UNUSED hl_status hl_preview_scene(const hl_preview *preview, hl_scene *scene, hl_scene **quick,
                                                 hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
