/* scene/check_tools.h - what the checks of cameras, lights and volumes share: errors that begin with a JSON
 * pointer. */
#ifndef HL_SCENE_CHECK_TOOLS_H
#define HL_SCENE_CHECK_TOOLS_H

#include "core/error.h"
#include "scene/check.h"
#include "scene/settings.h"

/* The object that is checked: "/lights/3". */
typedef struct hl_checker {
  hl_error *error;
  char place[80];
} hl_checker;

/* "PLACE/KEY: PROBLEM" */
hl_status hl_check_refuse(const hl_checker *check, const char *key, const char *problem);

/* Settings of one row, and of all rows that an object of this type has (of kinds without types 0). */
hl_status hl_check_key(const hl_checker *check, hl_setting_kind kind, const char *key, const void *object);
hl_status hl_check_settings(const hl_checker *check, hl_setting_kind kind, const void *object, int type);

/* A number from low to high that is in no table. */
hl_status hl_check_range(const hl_checker *check, const char *key, double value, double low, double high,
                         const char *mend);

/* Coordinates within HL_LIMIT_LENGTH, and those that are a direction too. */
hl_status hl_check_point(const hl_checker *check, const char *key, const double v[3]);
hl_status hl_check_direction(const hl_checker *check, const char *key, const double v[3]);

/* An array that is there, of at most `limit` entries. */
hl_status hl_check_count(const hl_checker *check, const char *key, const void *points, size_t count,
                         size_t limit);

/* Number `index` of a scene's lights by itself (check_light.c). */
hl_status hl_light_check(const hl_light *light, size_t index, hl_error *error);

#endif
