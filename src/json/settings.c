/* json/settings.c - reads settings from JSON by the rows of their tables.
 *
 * Types and names are checked here; ranges are checked later, when a scene is created. Settings that may be a
 * whole number or a word are an exception. Their words are stored as numbers outside of the range, so that
 * the range of a number must be checked here. */
#include "json/settings.h"

#include <string.h>

#include "scene/settings.h"
#include "text/color.h"
#include "text/plain.h"

enum { MOST_KEYS = 48, MOST_NAMES = 16 };

hl_status hl_json_settings_object(hl_json_reader *reader, const json_t *value, hl_setting_kind kind, int type,
                                  const char *const *others) {
  const char *keys[MOST_KEYS + 1] = {0};
  size_t count = 0;
  for (size_t s = 0; s < hl_setting_count(kind) && count < MOST_KEYS; s++) {
    const hl_setting *setting = hl_setting_get(kind, s);
    if (strchr(setting->key, '/') != NULL) continue;
    if (type < 0 || hl_setting_is_for(setting, type)) keys[count++] = setting->key;
  }
  for (; others != NULL && *others != NULL && count < MOST_KEYS; others++) keys[count++] = *others;
  return hl_json_object(reader, value, keys);
}

static hl_status read_choice(hl_json_reader *reader, const json_t *object, const char *key,
                             const hl_setting *setting, int *value) {
  const char *names[MOST_NAMES + 1] = {0};
  int chosen = -1;
  for (int n = 0; n < MOST_NAMES && setting->choices[n].name != NULL; n++)
    names[n] = setting->choices[n].name;
  hl_status status = hl_json_choice(reader, object, key, names, 0, &chosen);
  if (status == HL_OK && chosen >= 0) *value = setting->choices[chosen].value;
  return status;
}

/* Reads a setting that is a whole number in the setting's range, or one of the setting's words. */
static hl_status read_whole_or_word(hl_json_reader *reader, const json_t *object, const char *key,
                                    const hl_setting *setting, int *value) {
  const json_t *member = json_object_get(object, key);
  if (member == NULL) return HL_OK;
  for (const hl_setting_choice *choice = setting->choices; json_is_string(member) && choice->name != NULL;
       choice++)
    if (strcmp(json_string_value(member), choice->name) == 0) {
      *value = choice->value;
      return HL_OK;
    }
  if (json_is_integer(member) && (double)json_integer_value(member) >= setting->low &&
      (double)json_integer_value(member) <= setting->high) {
    *value = (int)json_integer_value(member);
    return HL_OK;
  }
  char mend[200];
  hl_setting_mend(setting, mend, sizeof mend);
  if (json_is_integer(member))
    return hl_json_fail(reader, HL_ERROR_INPUT, key, "%lld is out of range: %s",
                        (long long)json_integer_value(member), mend);
  return hl_json_fail(reader, HL_ERROR_INPUT, key, "is %s: %s",
                      json_is_string(member) ? "another word" : hl_json_type_name(member), mend);
}

/* Reads a colour, which is linear in a scene. A colour's name or code is sRGB, as options take it: the error
 * says which numbers it stands for. */
static hl_status read_color(hl_json_reader *reader, const json_t *object, const char *key, double *color) {
  const char *text = json_string_value(json_object_get(object, key));
  double meant[3];
  if (text == NULL) return hl_json_numbers(reader, object, key, 3, color);
  if (!hl_parse_color(text, 0, 1, meant))
    return hl_json_fail(reader, HL_ERROR_INPUT, key, "is a string: give linear [r, g, b]");
  char numbers[80];
  hl_plain_print(numbers, sizeof numbers, "%.3g, %.3g, %.3g", meant[0], meant[1], meant[2]);
  return hl_json_fail(reader, HL_ERROR_INPUT, key, "is a string: give linear [r, g, b]; \"%.40s\" is [%s]",
                      text, numbers);
}

static hl_status read_setting(hl_json_reader *reader, const json_t *object, const hl_setting *setting,
                              void *target) {
  const char *slash = strrchr(setting->key, '/'), *key = slash != NULL ? slash + 1 : setting->key;
  void *field = hl_setting_field(setting, target);
  switch (setting->type) {
    case HL_SETTING_FLAG: return hl_json_flag(reader, object, key, field);
    case HL_SETTING_CHOICE: return read_choice(reader, object, key, setting, field);
    case HL_SETTING_NUMBER: return hl_json_number(reader, object, key, field);
    case HL_SETTING_POINT:
    case HL_SETTING_DIRECTION: return hl_json_numbers(reader, object, key, 3, field);
    case HL_SETTING_COLOR: return read_color(reader, object, key, field);
    case HL_SETTING_WHOLE: break;
  }
  return setting->choices != NULL ? read_whole_or_word(reader, object, key, setting, field)
                                  : hl_json_integer(reader, object, key, field);
}

hl_status hl_json_setting(hl_json_reader *reader, const json_t *object, hl_setting_kind kind, const char *key,
                          void *target) {
  return read_setting(reader, object, hl_setting_find(kind, key), target);
}

hl_status hl_json_settings(hl_json_reader *reader, const json_t *object, hl_setting_kind kind, int type,
                           void *target) {
  hl_status status = HL_OK;
  for (size_t s = 0; s < hl_setting_count(kind) && status == HL_OK; s++) {
    const hl_setting *setting = hl_setting_get(kind, s);
    if (strchr(setting->key, '/') == NULL && hl_setting_is_for(setting, type))
      status = read_setting(reader, object, setting, target);
  }
  return status;
}

hl_status hl_json_settings_member(hl_json_reader *reader, const json_t *value, const char *key,
                                  hl_setting_kind kind, void *target) {
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, key);
  hl_status status = hl_json_settings_object(reader, value, kind, -1, NULL);
  if (status == HL_OK) status = hl_json_settings(reader, value, kind, 0, target);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}
