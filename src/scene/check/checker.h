/* scene/check/checker.h - checks single values of a description. Errors begin with the JSON pointer of the
 * value. */
#ifndef HL_SCENE_CHECK_CHECKER_H
#define HL_SCENE_CHECK_CHECKER_H

#include "core/error.h"
#include "scene/check/limits.h"
#include "scene/settings.h"

/* The object whose values are checked, and the place at which errors are stored. place: the JSON pointer of
 * the object, such as "/lights/3". */
typedef struct hl_checker {
  hl_error *error;
  char place[80];
} hl_checker;

/* Reports a bad value: fails with the line "PLACE/KEY: PROBLEM". */
hl_status hl_check_refuse(const hl_checker *check, const char *key, const char *problem);

/* By the tables of settings, hl_check_key() checks one setting, and hl_check_settings() checks all settings
 * that an object of a type has. type: 0 for kinds of objects without types. */
hl_status hl_check_key(const hl_checker *check, hl_setting_kind kind, const char *key, const void *object);
hl_status hl_check_settings(const hl_checker *check, hl_setting_kind kind, const void *object, int type);

/* Checks that a number that is in no table of settings lies between `low` and `high`. */
hl_status hl_check_range(const hl_checker *check, const char *key, double value, double low, double high,
                         const char *mend);

/* hl_check_point_opacity() and hl_check_point_color() check the opacity and the colour of point `index` of
 * the list `key` of a transfer function's points. */
hl_status hl_check_point_opacity(const hl_checker *check, const char *key, size_t index, double opacity);
hl_status hl_check_point_color(const hl_checker *check, const char *key, size_t index, const double color[3]);

/* hl_check_point() checks that coordinates are within HL_LIMIT_LENGTH, and hl_check_direction() checks that a
 * direction is not zero. */
hl_status hl_check_point(const hl_checker *check, const char *key, const double v[3]);
hl_status hl_check_direction(const hl_checker *check, const char *key, const double v[3]);

/* Checks the pixels of an image, [height][width][3], linear RGB. */
hl_status hl_check_pixels(const hl_checker *check, const float *pixels, int width, int height);

/* Checks that an array exists and has at most `limit` entries. */
hl_status hl_check_count(const hl_checker *check, const char *key, const void *points, size_t count,
                         size_t limit);

#endif
