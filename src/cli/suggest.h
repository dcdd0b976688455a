/* cli/suggest.h - finds suggestions for an unknown name. */
#ifndef HL_CLI_SUGGEST_H
#define HL_CLI_SUGGEST_H

#include <stddef.h>

/* The option that a word of other programs means ("rotate" means "azimuth"). The result may have a value
 * ("mip" means "look mip"). Its option is one of the options that option(data, i) lists. Null if none is
 * known. */
const char *synonym_of(const char *word, const char *(*option)(const void *data, size_t index),
                       const void *data);

/* Returns the JSON text that sets the setting of this name, for settings that only scene files have:
 * "diffuse" gives "\"material\": { \"diffuse\": 0.7 } in a volume"; null if no such setting is known. */
const char *scene_setting_of(const char *word);

/* The value that a word of other programs means for an option (for "view", "anterior" means "front"); null if
 * none is known. */
const char *value_meant_by(const char *option, const char *word);

/* The command that a word of other programs means ("movie" means "animate"); null if none is known. */
const char *command_meant_by(const char *word);

#endif
