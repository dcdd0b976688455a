/* scene/check/checker.c - checks single values of a description. Errors begin with the JSON pointer of the
 * value. */
#include "scene/check/checker.h"

#include <math.h>
#include <stdio.h>

#include "core/vector.h"

hl_status hl_check_refuse(const hl_checker *check, const char *key, const char *problem) {
  return hl_fail(check->error, HL_ERROR_INPUT, "%s/%s: %s", check->place, key, problem);
}

hl_status hl_check_key(const hl_checker *check, hl_setting_kind kind, const char *key, const void *object) {
  return hl_settings_check_key(kind, key, object, check->place, check->error);
}

hl_status hl_check_settings(const hl_checker *check, hl_setting_kind kind, const void *object, int type) {
  return hl_settings_check(kind, object, type, check->place, check->error);
}

hl_status hl_check_range(const hl_checker *check, const char *key, double value, double low, double high,
                         const char *mend) {
  /* the comparison is false for a NaN, which is therefore refused */
  if (value >= low && value <= high) return HL_OK;
  const char *problem = isnan(value)            ? "is not a number"
                        : value < 0 && low == 0 ? "is negative"
                                                : "is out of range";
  return hl_fail(check->error, HL_ERROR_INPUT, "%s/%s: %.9g %s: %s", check->place, key, value, problem, mend);
}

hl_status hl_check_point_opacity(const hl_checker *check, const char *key, size_t index, double opacity) {
  char element[64];
  snprintf(element, sizeof element, "%s/%zu/1", key, index);
  return hl_check_range(check, element, opacity, 0, 1, "give an opacity from 0 to 1");
}

hl_status hl_check_point_color(const hl_checker *check, const char *key, size_t index,
                               const double color[3]) {
  hl_status status = HL_OK;
  for (int channel = 0; status == HL_OK && channel < 3; channel++) {
    char element[64];
    snprintf(element, sizeof element, "%s/%zu/%d", key, index, channel + 1);
    status = hl_check_range(check, element, color[channel], 0, 1, "give linear RGB, each from 0 to 1");
  }
  return status;
}

hl_status hl_check_point(const hl_checker *check, const char *key, const double v[3]) {
  for (int a = 0; a < 3; a++) {
    char element[48];
    snprintf(element, sizeof element, "%s/%d", key, a);
    hl_status status = hl_check_range(check, element, v[a], -HL_LIMIT_LENGTH, HL_LIMIT_LENGTH,
                                      "give a coordinate between -1e15 and 1e15");
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

hl_status hl_check_direction(const hl_checker *check, const char *key, const double v[3]) {
  hl_status status = hl_check_point(check, key, v);
  if (status != HL_OK) return status;
  double length = vec3_length(vec3_of(v));
  if (length >= 1e-100) return HL_OK;
  return hl_check_refuse(check, key,
                         length > 0 ? "is too short to have a direction: give a vector of about unit length"
                                    : "has no length: give the direction as three numbers, not all 0");
}

hl_status hl_check_count(const hl_checker *check, const char *key, const void *points, size_t count,
                         size_t limit) {
  if (count > 0 && points == NULL)
    return hl_fail(check->error, HL_ERROR_ARGUMENT, "%s/%s: is null but its count is %zu", check->place, key,
                   count);
  if (count > limit)
    return hl_fail(check->error, HL_ERROR_INPUT, "%s/%s: has %zu entries: at most %zu are allowed",
                   check->place, key, count, limit);
  return HL_OK;
}

hl_status hl_check_pixels(const hl_checker *check, const float *pixels, int width, int height) {
  const char *size = "give an image of at most 32768 pixels a side, 67108864 in all";
  hl_status status;
  if ((status = hl_check_range(check, "width", width, 1, HL_LIMIT_TEXTURE_SIDE, size)) != HL_OK)
    return status;
  if ((status = hl_check_range(check, "height", height, 1, HL_LIMIT_TEXTURE_SIDE, size)) != HL_OK)
    return status;
  size_t count = (size_t)width * (size_t)height;
  if (count > HL_LIMIT_TEXTURE_PIXELS)
    return hl_fail(check->error, HL_ERROR_INPUT, "%s: has %d x %d pixels: %s", check->place, width, height,
                   size);
  for (size_t i = 0; i < 3 * count; i++)
    if (!(pixels[i] >= 0 && (double)pixels[i] <= HL_LIMIT_TEXTURE_VALUE))
      return hl_fail(check->error, HL_ERROR_INPUT,
                     "%s/file: pixel (%zu, %zu) has %.9g in channel %zu: give linear RGB from 0 to 1e6",
                     check->place, i / 3 % (size_t)width, i / 3 / (size_t)width, (double)pixels[i], i % 3);
  return HL_OK;
}
