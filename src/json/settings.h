/* json/settings.h - reads settings from JSON by the rows of their tables. */
#ifndef HL_JSON_SETTINGS_H
#define HL_JSON_SETTINGS_H

#include <halflight/settings.h>

#include "json/read.h"

/* Checks that a value is an object whose keys are all in the table or in the null-terminated list `others`.
 * type: the type of the light or camera, whose keys alone are allowed; -1 allows the keys of every type. */
hl_status hl_json_settings_object(hl_json_reader *reader, const json_t *value, hl_setting_kind kind, int type,
                                  const char *const *others);

/* Reads the object `value` into the struct `target`. key: the object's name in errors. Every key of the
 * object must stand in the table. If value is null, nothing is read. */
hl_status hl_json_settings_member(hl_json_reader *reader, const json_t *value, const char *key,
                                  hl_setting_kind kind, void *target);

/* Reads one key of the table into the struct `target`. If the object lacks the key, nothing is read. object:
 * the object that has the last part of the key; for the key "transform/translate" it is the object
 * "transform". */
hl_status hl_json_setting(hl_json_reader *reader, const json_t *object, hl_setting_kind kind, const char *key,
                          void *target);
/* Reads all keys of a table that have no "/" and belong to a type of light or camera. */
hl_status hl_json_settings(hl_json_reader *reader, const json_t *object, hl_setting_kind kind, int type,
                           void *target);

#endif
