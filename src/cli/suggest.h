/* cli/suggest.h - suggestions for an unknown name. */
#ifndef HL_CLI_SUGGEST_H
#define HL_CLI_SUGGEST_H

#include <stddef.h>

/* The option that a word of other programs means ("rotate" means "azimuth"), perhaps with a value ("mip"
 * means "look mip"). It is one of the options that option(data, i) lists; null: none is known. */
const char *synonym_of(const char *word, const char *(*option)(const void *data, size_t index),
                       const void *data);

/* The JSON that sets a setting which only scene files have, found by the setting's name ("diffuse" gives
 * "\"material\": { \"diffuse\": 0.7 } in a volume"); null: none is known. */
const char *scene_setting_of(const char *word);

/* The value of an option that another word means (for "view", "anterior" means "front"); null: none is
 * known. */
const char *value_meant_by(const char *option, const char *word);

/* The command that another word means ("movie" means "animate"); null: none is known. */
const char *command_meant_by(const char *word);

#endif
