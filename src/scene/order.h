/* scene/order.h - the order in which frames take a scene's lights, volumes and meshes.
 *
 * Sheets are shared by lights one after the other, and sums of floats depend on their order. So frames take a
 * scene's things in an order that depends on the things themselves, and not on their places in the scene's
 * lists. Scenes that differ only in the order of their lists have the same pictures, to the byte. */
#ifndef HL_SCENE_ORDER_H
#define HL_SCENE_ORDER_H

#include <halflight/scene.h>

#include "core/error.h"

/* The order of a scene's things. Each array holds the numbers that things have in the placed description's
 * list, in the order of frames. */
typedef struct scene_order {
  int *lights;  /* owned; [light_count]; the numbers of lights; the suns of the sky come last, as in the
                 * description's list */
  int *volumes; /* owned; [volume_count] */
  int *meshes;  /* owned; [mesh_count] */
} scene_order;

/* Finds the order of a scene's things. given: the description as it was given. Its lights may be placed in
 * the camera's axes, so their order does not depend on the camera. placed: the description that is
 * rendered; its first lights are the lights of `given`. Things that look alike in a picture may have any
 * order. Release the order after an error, too. */
hl_status hl_scene_order_find(hl_context *context, const hl_scene_description *given,
                              const hl_scene_description *placed, scene_order *order, hl_error *error);
void hl_scene_order_release(hl_context *context, scene_order *order);

#endif
