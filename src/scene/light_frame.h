/* scene/light_frame.h - lights that are fixed to the camera, placed in the world. */
#ifndef HL_SCENE_LIGHT_FRAME_H
#define HL_SCENE_LIGHT_FRAME_H

#include "scene/scene.h"

/* The way the light travels, in the world: its direction. */
vec3 hl_light_way(const hl_camera *camera, const hl_light *light);

/* Makes *to the same lights with all of them in the world. Images are shared with from; the array and the
 * vertices of its polygons are owned by *to: hl_placed_lights_release(). */
hl_status hl_lights_place(hl_context *context, const hl_scene_description *from, hl_scene_description *to,
                          hl_error *error);
void hl_placed_lights_release(hl_context *context, hl_scene_description *placed);

#endif
