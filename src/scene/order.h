/* scene/order.h - the order in which frames take a scene's lights, volumes and meshes.
 *
 * Sheets are shared by lights one after the other, and sums of floats depend on their order. So frames take
 * what a scene holds in an order that depends on what the things are, and not on where the scene lists them:
 * scenes that differ in the order of their lists have the same pictures, to the byte. */
#ifndef HL_SCENE_ORDER_H
#define HL_SCENE_ORDER_H

#include <halflight/scene.h>

#include "core/error.h"

/* Each array holds the places of things in the placed description's list, in the order of frames. */
typedef struct scene_order {
  int *lights;  /* owned; [light_count]; the suns of the sky come last, as in the list */
  int *volumes; /* owned; [volume_count] */
  int *meshes;  /* owned; [mesh_count] */
} scene_order;

/* given: the description as it was given, whose lights are where the camera's axes have them: their order is
 * then the same wherever the camera stands. placed: the one that is rendered; its first lights are those of
 * `given`. Things that are alike in all that a picture shows have one order as good as another. After an
 * error, too, the order is to be released. */
hl_status hl_scene_order_find(hl_context *context, const hl_scene_description *given,
                              const hl_scene_description *placed, scene_order *order, hl_error *error);
void hl_scene_order_release(hl_context *context, scene_order *order);

#endif
