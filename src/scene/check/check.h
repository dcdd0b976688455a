/* scene/check/check.h - checks whether a description of a scene is possible. */
#ifndef HL_SCENE_CHECK_CHECK_H
#define HL_SCENE_CHECK_CHECK_H

#include <halflight/layers.h>
#include <halflight/scene.h>

#include "scene/check/checker.h"

/* Checks every field of a scene's description; reports the first fault as "JSON pointer: what is wrong: how
 * to mend it". */
hl_status hl_description_check(const hl_scene_description *description, hl_error *error);

/* Checks light number `index` of a scene by itself, without the rest of the scene. */
hl_status hl_light_check(const hl_light *light, size_t index, hl_error *error);

/* Checks one volume of a description, before a camera frames it. */
hl_status hl_scene_volume_check(const hl_scene_volume *volume, size_t index, hl_error *error);

/* Checks the cuts of a volume or a scene. */
hl_status hl_cuts_check(const hl_checker *check, const hl_cut *cuts, size_t count);

/* Checks one mesh of a description. */
hl_status hl_scene_mesh_check(const hl_scene_mesh *mesh, size_t index, hl_error *error);

/* Checks a transfer function. place: its name in errors ("/volumes/0/transfer_function"). */
hl_status hl_transfer_function_check(const hl_transfer_function *function, const char *place,
                                     hl_error *error);

/* Checks the layers that are wanted of a frame of a scene. layers: null if no layers are wanted. */
hl_status hl_layers_check(const hl_layers *layers, const hl_scene_description *scene, hl_error *error);

#endif
