/* halflight/preview.h - makes quick pictures while a camera, a light or a colour changes, by rendering the
 * scene with coarser copies of its volumes.
 *
 * The time of a picture grows with its number of pixels times its number of sheets. If a preview only had
 * fewer sheets, these would miss thin surfaces that lie between two sheets. So a preview also has copies of
 * the volumes in which 2, 4 or 8 voxels along each axis are merged into one. For a scene, the preview takes
 * the copies whose voxels are about as long as the distance between the scene's sheets. Of all previews that
 * take the same time, the one whose sheets are as far apart as its pixels are long is nearest to the exact
 * picture. examples/c/preview.c is a loop that turns a volume at an interactive rate in this way. */
#ifndef HALFLIGHT_PREVIEW_H
#define HALFLIGHT_PREVIEW_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Coarser copies of a scene's volumes. Any number of threads may use it at once. */
typedef struct hl_preview hl_preview;

/* Makes the coarser copies of the scene's volumes and masks, which takes one pass over their voxels and a
 * seventh of their memory. The caller may run this function in a thread of its own while the scene is
 * rendered. In copies of label maps and masks, a voxel has the label that most of the merged voxels have.
 * These volumes get no copies: volumes with colours, volumes over ranks, volumes of fewer than 64^3 voxels,
 * and label maps with labels beyond 2^24, which floats would round. A volume that the scene uses as a label
 * map gets copies of labels; every other volume gets copies of values. *preview is owned by the caller, who
 * releases it. Errors: HL_ERROR_MEMORY; HL_ERROR_CANCELLED. */
HL_API HL_WARN_UNUSED hl_status hl_preview_create(hl_context *context, const hl_scene *scene,
                                                  hl_preview **preview, hl_error *error);
HL_API void hl_preview_destroy(hl_preview *preview); /* null is allowed */

/* Makes the scene that is rendered while something moves. Each volume or mask that the preview has copies of
 * is replaced by the coarsest copy whose shortest voxel edge is at most the square root of 2 times the
 * distance of the scene's sheets. A later scene may use a volume as a label map that the preview's scene used
 * as values, or the other way round. The first call with such a scene makes the missing copies; if memory is
 * short for them, the volume itself is rendered. render.sheet_spacing is converted to the voxels of the
 * copies, so that the distance between sheets stays the same. Everything else stays the same. If no copy is
 * coarse enough, *quick is the scene itself, retained. Use one renderer for quick scenes alone, because a
 * renderer prepares a volume anew when the volume changes. */
HL_API HL_WARN_UNUSED hl_status hl_preview_scene(hl_preview *preview, hl_scene *scene, hl_scene **quick,
                                                 hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
