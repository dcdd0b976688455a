/* cli/suggest.h - suggestions for an unknown name. */
#ifndef HL_CLI_SUGGEST_H
#define HL_CLI_SUGGEST_H

#include <stddef.h>

/* The option for a word of other programs ("rotate" -> "azimuth"; with a value, "mip" -> "look mip"), of
 * those that option(data, i) lists; null: none is known. */
const char *synonym_of(const char *word, const char *(*option)(const void *data, size_t index),
                       const void *data);

/* For the name of a setting that only scene files have, the JSON that sets it ("diffuse" -> "\"material\": {
 * \"diffuse\": 0.7 } in a volume"); null: none is known. */
const char *scene_setting_of(const char *word);

/* The value of an option for another word with its meaning ("view", "anterior" -> "front"); null: none is
 * known. */
const char *value_meant_by(const char *option, const char *word);

/* The command for another word with its meaning ("movie" -> "animate"); null: none is known. */
const char *command_meant_by(const char *word);

#endif
