/* scene/order.h - finds the order in which frames take a scene's lights, volumes and meshes.
 *
 * A picture depends slightly on the order of lights, volumes and meshes: lights get their sheets one after
 * the other, and sums of floats depend on the order of the terms. So frames use an order that depends on the
 * lights, volumes and meshes themselves, and not on their places in the scene's lists. Scenes that differ
 * only in the order of their lists have the same pictures, to the byte. */
#ifndef HL_SCENE_ORDER_H
#define HL_SCENE_ORDER_H

#include <halflight/scene.h>

#include "core/error.h"

/* The order of a scene's lights, volumes and meshes. Each array lists indices of the placed description, in
 * the order in which frames take the objects. */
typedef struct scene_order {
  /* owned; [light_count]; indices of lights; the suns of the sky come last, as in the placed description */
  int *lights;
  int *volumes; /* owned; [volume_count]; indices of volumes */
  int *meshes;  /* owned; [mesh_count]; indices of meshes */
} scene_order;

/* Finds the order of a scene's lights, volumes and meshes. given: the description as the program gave it. The
 * lights of this description may be in the camera's axes, so that the order of lights does not depend on the
 * camera. placed: the description that is rendered; its first lights are the lights of `given`. Objects that
 * no picture can tell apart may have any order. Release the order after an error, too. */
hl_status hl_scene_order_find(hl_context *context, const hl_scene_description *given,
                              const hl_scene_description *placed, scene_order *order, hl_error *error);
void hl_scene_order_release(hl_context *context, scene_order *order);

#endif
