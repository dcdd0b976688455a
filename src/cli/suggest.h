/* cli/suggest.h - what somebody who typed an unknown name may have meant. */
#ifndef HL_CLI_SUGGEST_H
#define HL_CLI_SUGGEST_H

#include "options.h"

/* The candidate nearest to text, or null if none is near. candidate(data, i) is null past the last. */
const char *nearest_name(const char *text, const char *(*candidate)(const void *data, size_t index),
                         const void *data);

/* The subcommand's option that does what a word of other programs means ("rotate" -> "azimuth"); null: none
 * is known. */
const char *synonym_of(const char *word, const cli_command *command);

/* The setting that a word names and that only a scene has, as the scene writes it ("emission" -> its JSON
 * with an example); null: none is known. */
const char *scene_setting_of(const char *word);

#endif
