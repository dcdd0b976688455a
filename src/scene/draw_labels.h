/* scene/draw_labels.h - label maps as what is rendered: a volume of smooth occupancy for each label that
 * shows. */
#ifndef HL_SCENE_DRAW_LABELS_H
#define HL_SCENE_DRAW_LABELS_H

#include "core/error.h"
#include "scene/scene.h"

/* A transfer function over a label map's own values: each visible label from half a number below to half a
 * number above it, in its colour. It tells framing, exposure and legends what is seen. function's points are
 * owned by the caller (hl_transfer_function_release). */
hl_status hl_labels_function(hl_context *context, const hl_scene_volume *volume,
                             hl_transfer_function *function, hl_error *error);

/* Replaces the label maps of a scene's placed description by volumes of occupancy; the scene then owns its
 * array of volumes (hl_drawn_labels_release). Nothing happens where there are no label maps. */
hl_status hl_labels_draw(hl_context *context, hl_scene *scene, hl_error *error);
void hl_drawn_labels_release(hl_context *context, hl_scene *scene);

#endif
