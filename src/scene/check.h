/* scene/check.h - is a description possible? And what the checks share. */
#ifndef HL_SCENE_CHECK_H
#define HL_SCENE_CHECK_H

#include <halflight/layers.h>
#include <halflight/scene.h>

#include "core/error.h"
#include "scene/limits.h"
#include "scene/settings.h"

/* Checks every field of a description; reports the first fault as "JSON pointer: what is wrong: how to mend
 * it". */
hl_status hl_description_check(const hl_scene_description *description, hl_error *error);

/* Checks one volume of a description, before a camera frames it. */
hl_status hl_scene_volume_check(const hl_scene_volume *volume, size_t index, hl_error *error);

/* Checks a transfer function; place: what errors call it ("/volumes/0/transfer_function"). */
hl_status hl_transfer_function_check(const hl_transfer_function *function, const char *place,
                                     hl_error *error);

/* Checks the layers that are wanted of a frame of this scene; null: none. */
hl_status hl_layers_check(const hl_layers *layers, const hl_scene_description *scene, hl_error *error);

/* ---- Tools for the checks of cameras, lights and volumes: errors that begin with a JSON pointer ---- */

/* The object that is checked: "/lights/3". */
typedef struct hl_checker {
  hl_error *error;
  char place[80];
} hl_checker;

/* Fails with "PLACE/KEY: PROBLEM". */
hl_status hl_check_refuse(const hl_checker *check, const char *key, const char *problem);

/* Check one setting, and all settings that an object of this type has (type 0 for kinds without types). */
hl_status hl_check_key(const hl_checker *check, hl_setting_kind kind, const char *key, const void *object);
hl_status hl_check_settings(const hl_checker *check, hl_setting_kind kind, const void *object, int type);

/* Checks a number that is in no table of settings: from low to high. */
hl_status hl_check_range(const hl_checker *check, const char *key, double value, double low, double high,
                         const char *mend);

/* Check that coordinates are within HL_LIMIT_LENGTH, and that a direction is not zero. */
hl_status hl_check_point(const hl_checker *check, const char *key, const double v[3]);
hl_status hl_check_direction(const hl_checker *check, const char *key, const double v[3]);

/* Checks that an array exists and has at most `limit` entries. */
hl_status hl_check_count(const hl_checker *check, const char *key, const void *points, size_t count,
                         size_t limit);

/* Checks light number `index` of a scene by itself (check_light.c). */
hl_status hl_light_check(const hl_light *light, size_t index, hl_error *error);

#endif
