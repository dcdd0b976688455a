/* scene/settings.h - defaults and checks by the rows of the tables of settings. */
#ifndef HL_SCENE_SETTINGS_H
#define HL_SCENE_SETTINGS_H

#include <stdbool.h>

#include <halflight/settings.h>

#include "core/error.h"
#include "core/key.h"

/* The field of a row in its struct. */
void *hl_setting_field(const hl_setting *setting, void *object);
const void *hl_setting_field_const(const hl_setting *setting, const void *object);

/* The value of a field whose type is FLAG, WHOLE or CHOICE. */
int hl_setting_whole(const hl_setting *setting, const void *object);

/* True if objects of this type (lights, cameras) have the row's key. type: 0 for kinds of objects without
 * types. */
bool hl_setting_is_for(const hl_setting *setting, int type);

/* True if the field equals the row's default. */
bool hl_setting_is_standard(const hl_setting *setting, const void *object);

/* Sets the fields of all rows to their defaults. */
void hl_settings_defaults(hl_setting_kind kind, void *object);

/* Adds the fields of all rows that objects of this type have to a key, in the rows' order. */
void hl_settings_key_add(hl_setting_kind kind, const void *object, int type, hl_key *key);

/* The name of one of the row's choices; null: no choice has this value. */
const char *hl_setting_choice_name(const hl_setting *setting, int value);

/* The row's `mend`, with the row's range filled in. */
void hl_setting_mend(const hl_setting *setting, char *text, size_t size);

/* Checks a field's value. place: the object's JSON pointer, for errors ("/render"). */
hl_status hl_setting_check(const hl_setting *setting, const void *object, const char *place, hl_error *error);

/* Checks one key of a table, as hl_setting_check() does by its row. */
hl_status hl_settings_check_key(hl_setting_kind kind, const char *key, const void *object, const char *place,
                                hl_error *error);

/* Checks all settings that objects of this type have, in the rows' order. */
hl_status hl_settings_check(hl_setting_kind kind, const void *object, int type, const char *place,
                            hl_error *error);

#endif
