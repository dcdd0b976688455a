/* cli/input.h - what subcommands take as INPUT: a scene, or a bare volume for which one is made. */
#ifndef HL_CLI_INPUT_H
#define HL_CLI_INPUT_H

#include <stdbool.h>

#include <halflight/halflight.h>

/* The part of a path after its last slash. */
const char *input_base_name(const char *path);

/* Scenes are told by name; where the name says nothing, by a first character '{'. */
bool input_is_scene(const char *path);

/* bare: the file is a volume. */
hl_status input_load(hl_context *context, const char *path, bool bare, hl_scene **scene, hl_error *error);

#endif
