/* scene/settings.c - sets default values, and checks values, by the rows of the tables of settings. */
#include "scene/settings.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "core/vector.h"
#include "elementary/elementary.h"
#include "text/plain.h"

_Static_assert(sizeof(hl_shadows) == sizeof(int), "fields of enumerators are read as int");

const hl_setting *hl_setting_find(hl_setting_kind kind, const char *key) {
  for (size_t s = 0; key != NULL && s < hl_setting_count(kind); s++)
    if (strcmp(hl_setting_get(kind, s)->key, key) == 0) return hl_setting_get(kind, s);
  return NULL;
}

void *hl_setting_field(const hl_setting *setting, void *object) { return (char *)object + setting->offset; }

const void *hl_setting_field_const(const hl_setting *setting, const void *object) {
  return (const char *)object + setting->offset;
}

int hl_setting_whole(const hl_setting *setting, const void *object) {
  int value;
  memcpy(&value, hl_setting_field_const(setting, object), sizeof value);
  return value;
}

bool hl_setting_is_for(const hl_setting *setting, int type) {
  return setting->only_for == 0 || (setting->only_for >> type & 1) != 0;
}

/* The number of doubles in a setting's field; 0 if the field is an int. */
static size_t doubles_of(const hl_setting *setting) {
  switch (setting->type) {
    case HL_SETTING_NUMBER: return 1;
    case HL_SETTING_POINT:
    case HL_SETTING_DIRECTION:
    case HL_SETTING_COLOR: return 3;
    case HL_SETTING_FLAG:
    case HL_SETTING_WHOLE:
    case HL_SETTING_CHOICE: break;
  }
  return 0;
}

bool hl_setting_is_standard(const hl_setting *setting, const void *object) {
  const double *numbers = hl_setting_field_const(setting, object);
  size_t count = doubles_of(setting);
  if (count == 0) return hl_setting_whole(setting, object) == (int)setting->standard[0];
  for (size_t n = 0; n < count; n++)
    if (numbers[n] != setting->standard[n]) return false;
  return true;
}

void hl_settings_defaults(hl_setting_kind kind, void *object) {
  for (size_t s = 0; s < hl_setting_count(kind); s++) {
    const hl_setting *setting = hl_setting_get(kind, s);
    const int whole = (int)setting->standard[0];
    if (doubles_of(setting) == 0) memcpy(hl_setting_field(setting, object), &whole, sizeof whole);
    else memcpy(hl_setting_field(setting, object), setting->standard, doubles_of(setting) * sizeof(double));
  }
}

void hl_settings_key_add(hl_setting_kind kind, const void *object, int type, hl_key *key) {
  for (size_t s = 0; s < hl_setting_count(kind); s++) {
    const hl_setting *setting = hl_setting_get(kind, s);
    const size_t count = doubles_of(setting);
    if (!hl_setting_is_for(setting, type)) continue;
    if (count == 0) hl_key_add_whole(key, hl_setting_whole(setting, object));
    else hl_key_add_numbers(key, hl_setting_field_const(setting, object), count);
  }
}

const char *hl_setting_choice_name(const hl_setting *setting, int value) {
  for (const hl_setting_choice *choice = setting->choices; choice != NULL && choice->name != NULL; choice++)
    if (choice->value == value) return choice->name;
  return NULL;
}

/* Writes a limit as a person would: 16384, 0.01, 1e6, 1e15. */
static int write_limit(char *text, size_t size, double limit) {
  const double exponent = round(hl_log10(fabs(limit)));
  if (fabs(limit) >= 1e5 && fabs(limit) == hl_pow(10, exponent))
    return hl_plain_print(text, size, "%s1e%.0f", limit < 0 ? "-" : "", exponent);
  return hl_plain_print(text, size, "%.9g", limit);
}

void hl_setting_mend(const hl_setting *setting, char *text, size_t size) {
  size_t used = 0;
  text[0] = 0;
  for (const char *at = setting->mend != NULL ? setting->mend : ""; *at != 0 && used + 1 < size;) {
    bool low = strncmp(at, "{low}", 5) == 0, high = strncmp(at, "{high}", 6) == 0;
    if (low || high) {
      used += (size_t)write_limit(text + used, size - used, low ? setting->low : setting->high);
      at += low ? 5 : 6;
    } else {
      text[used++] = *at++;
      text[used] = 0;
    }
  }
}

/* Checks that a number is in a setting's range. key: the key of the number in errors ("position/2"). */
static hl_status check_number(const hl_setting *setting, double value, const char *place, const char *key,
                              hl_error *error) {
  if (value <= setting->high && (setting->open_low ? value > setting->low : value >= setting->low))
    return HL_OK;
  const char *problem = isnan(value)                                 ? "is not a number"
                        : setting->open_low && value <= setting->low ? "is not above 0"
                        : value < 0 && setting->low == 0             ? "is negative"
                                                                     : "is out of range";
  char mend[200];
  hl_setting_mend(setting, mend, sizeof mend);
  return hl_fail(error, HL_ERROR_INPUT, "%s/%s: %.9g %s: %s", place, key, value, problem, mend);
}

static hl_status check_length(const hl_setting *setting, const double v[3], const char *place,
                              hl_error *error) {
  double length = vec3_length(vec3_of(v));
  if (length >= 1e-100) return HL_OK;
  return hl_fail(error, HL_ERROR_INPUT, "%s/%s: %s", place, setting->key,
                 length > 0 ? "is too short to have a direction: give a vector of about unit length"
                            : "has no length: give the direction as three numbers, not all 0");
}

hl_status hl_setting_check(const hl_setting *setting, const void *object, const char *place,
                           hl_error *error) {
  const double *numbers = hl_setting_field_const(setting, object);
  size_t count = doubles_of(setting);
  if (setting->type == HL_SETTING_FLAG) return HL_OK;
  if (count == 0) {
    int value = hl_setting_whole(setting, object);
    if (hl_setting_choice_name(setting, value) != NULL) return HL_OK;
    if (setting->type == HL_SETTING_WHOLE) return check_number(setting, value, place, setting->key, error);
    if (setting->optional && value == (int)setting->standard[0]) return HL_OK;
    return hl_fail(error, HL_ERROR_INPUT, "%s/%s: %d is no known choice: use the enumerators of scene.h",
                   place, setting->key, value);
  }
  if (count == 1) return check_number(setting, numbers[0], place, setting->key, error);
  hl_status status = HL_OK;
  for (size_t n = 0; n < count && status == HL_OK; n++) {
    char key[64];
    snprintf(key, sizeof key, "%s/%zu", setting->key, n);
    status = check_number(setting, numbers[n], place, key, error);
  }
  return status == HL_OK && setting->type == HL_SETTING_DIRECTION
             ? check_length(setting, numbers, place, error)
             : status;
}

hl_status hl_settings_check_key(hl_setting_kind kind, const char *key, const void *object, const char *place,
                                hl_error *error) {
  return hl_setting_check(hl_setting_find(kind, key), object, place, error);
}

hl_status hl_settings_check(hl_setting_kind kind, const void *object, int type, const char *place,
                            hl_error *error) {
  hl_status status = HL_OK;
  for (size_t s = 0; s < hl_setting_count(kind) && status == HL_OK; s++)
    if (hl_setting_is_for(hl_setting_get(kind, s), type))
      status = hl_setting_check(hl_setting_get(kind, s), object, place, error);
  return status;
}
