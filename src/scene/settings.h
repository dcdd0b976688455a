/* scene/settings.h - sets default values, and checks values, by the rows of the tables of settings. */
#ifndef HL_SCENE_SETTINGS_H
#define HL_SCENE_SETTINGS_H

#include <stdbool.h>

#include <halflight/settings.h>

#include "core/error.h"
#include "core/key.h"

/* Returns the address of the field, in an object, that a row of a table of settings describes. */
void *hl_setting_field(const hl_setting *setting, void *object);
const void *hl_setting_field_const(const hl_setting *setting, const void *object);

/* The value of a setting's field whose type is FLAG, WHOLE or CHOICE. */
int hl_setting_whole(const hl_setting *setting, const void *object);

/* Returns whether objects of a given type (lights or cameras) have the setting of a row. type: 0 for kinds of
 * objects without types. */
bool hl_setting_is_for(const hl_setting *setting, int type);

/* Returns whether the field of a setting has its default value. */
bool hl_setting_is_standard(const hl_setting *setting, const void *object);

/* Sets the fields of all settings of an object to their defaults. */
void hl_settings_defaults(hl_setting_kind kind, void *object);

/* Adds to a key the fields of all settings that objects of a type have, in the order of the rows. */
void hl_settings_key_add(hl_setting_kind kind, const void *object, int type, hl_key *key);

/* The name of one of a setting's choices; null if no choice has this value. */
const char *hl_setting_choice_name(const hl_setting *setting, int value);

/* Writes the advice `mend` of a setting, with the setting's range filled in. */
void hl_setting_mend(const hl_setting *setting, char *text, size_t size);

/* Checks the value of one setting. place: the JSON pointer of the object, for errors ("/render"). */
hl_status hl_setting_check(const hl_setting *setting, const void *object, const char *place, hl_error *error);

/* Checks the value of the setting that has a given key, as hl_setting_check() does. */
hl_status hl_settings_check_key(hl_setting_kind kind, const char *key, const void *object, const char *place,
                                hl_error *error);

/* Checks all settings that objects of a type have, in the order of the rows. */
hl_status hl_settings_check(hl_setting_kind kind, const void *object, int type, const char *place,
                            hl_error *error);

#endif
