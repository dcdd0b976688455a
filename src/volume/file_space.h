/* volume/file_space.h - the anatomical space of a volume's world: the space that the caller states in place
 * of the file's (hl_volume_load_options.file_space), and the space into which the world is turned. */
#ifndef HL_VOLUME_FILE_SPACE_H
#define HL_VOLUME_FILE_SPACE_H

#include "volume/volume.h"

/* Gives a volume the space that three letters state (text/body_axes.h), and turns its world where they ask
 * for that. letters: may be null, which leaves the volume as it is. path: the file's name, for the warning
 * that is logged if the file tells another space. */
void hl_volume_state_space(hl_context *context, const char *path, const char *letters, hl_volume *volume);

/* Converts a volume's world to another anatomical space: changes the signs of x, of y or of both. Logs the
 * conversion. Nothing is done if `wanted` or the volume's space is unknown. */
void hl_volume_turn_into(hl_context *context, const char *path, hl_space wanted, hl_volume *volume);

#endif
