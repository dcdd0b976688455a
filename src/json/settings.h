/* json/settings.h - settings from JSON, by the rows of their tables. */
#ifndef HL_JSON_SETTINGS_H
#define HL_JSON_SETTINGS_H

#include <halflight/settings.h>

#include "json/read.h"

/* The value must be an object whose keys are all in the table or in the null-terminated list of others. type:
 * that of the light or camera, whose keys alone are allowed; -1: those of all types. */
hl_status hl_json_settings_object(hl_json_reader *reader, const json_t *value, hl_setting_kind kind, int type,
                                  const char *const *others);

/* Reads the object `key` into the struct `target`: a table's keys, without types, and no others. value null:
 * the object is absent, and nothing is read. */
hl_status hl_json_settings_member(hl_json_reader *reader, const json_t *value, const char *key,
                                  hl_setting_kind kind, void *target);

/* Reads what an object says for rows of a table into the struct `target`: for one key, which may be absent
 * ("rotate/axis" is read from the object "rotate" itself), and for all keys without a "/". */
hl_status hl_json_setting(hl_json_reader *reader, const json_t *object, hl_setting_kind kind, const char *key,
                          void *target);
hl_status hl_json_settings(hl_json_reader *reader, const json_t *object, hl_setting_kind kind, int type,
                           void *target);

#endif
