/* guess/for_volume.h - the camera and the light that a scene gets where it says nothing about them. */
#ifndef HL_GUESS_FOR_VOLUME_H
#define HL_GUESS_FOR_VOLUME_H

#include "scene/scene.h"

/* The camera that a scene without one gets: a three-quarter view that frames the volumes. Its type and
 * fovy_deg stay. */
hl_status hl_scene_frame(const hl_scene_description *description, hl_camera *camera, hl_error *error);

/* The light that a scene without lights gets: soft, from the upper left of the camera, with which it goes. */
void hl_scene_key_light(hl_light *light);

#endif
