/* cli/suggest.h - finds suggestions for an unknown name. */
#ifndef HL_CLI_SUGGEST_H
#define HL_CLI_SUGGEST_H

#include <stdbool.h>
#include <stddef.h>

/* The option that a word of other programs means ("rotate" means "azimuth"). The result may have a value
 * ("mip" means "look mip"). Its option is one of the options that option(data, i) lists. Null if none is
 * known. */
const char *synonym_of(const char *word, const char *(*option)(const void *data, size_t index),
                       const void *data);

/* Writes the JSON text of a setting that only scene files have, for the word of an option that does not
 * exist. "diffuse" gives "\"material\": { \"diffuse\": 0.7 } in a volume". The word may be the key of any
 * setting of a scene, spelled as an option. Returns false if no such setting is known. */
bool scene_setting_of(const char *word, char *text, size_t size);

/* Returns a sentence about an option that does not exist, which names the option or command with the same
 * purpose; null if none is known. */
const char *answer_to(const char *word);

/* The value that a word of other programs means for an option (for "view", "anterior" means "front"); null if
 * none is known. */
const char *value_meant_by(const char *option, const char *word);

/* The command that a word of other programs means ("movie" means "animate"); null if none is known. */
const char *command_meant_by(const char *word);

#endif
