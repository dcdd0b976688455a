/* cli/suggest.h - suggestions for an unknown name. */
#ifndef HL_CLI_SUGGEST_H
#define HL_CLI_SUGGEST_H

#include <stddef.h>

/* The option for a word of other programs ("rotate" -> "azimuth"), of those that option(data, i) lists; null:
 * none is known. */
const char *synonym_of(const char *word, const char *(*option)(const void *data, size_t index),
                       const void *data);

/* For the name of a setting that only scene files have, the JSON that sets it ("diffuse" -> "\"material\": {
 * \"diffuse\": 0.7 } in a volume"); null: none is known. */
const char *scene_setting_of(const char *word);

#endif
