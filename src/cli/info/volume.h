/* cli/info/volume.h - prints the properties of a volume. */
#ifndef HL_CLI_INFO_VOLUME_H
#define HL_CLI_INFO_VOLUME_H

#include "cli/host.h"
#include "cli/json_writer.h"

/* Prints the properties of a volume. json: the writer to which an object is added; if null, text is printed.
 * path: the name of the volume's file, from which its kind is guessed, too. unit: the unit of lengths; null
 * for the file's own. labels: whether the labels of a label map are listed. table: a table of their names,
 * which makes any volume a label map; null if there is none. Returns the exit code. */
int info_tell_volume(cli_host *host, json_writer *json, const char *path, hl_volume *volume, const char *unit,
                     bool labels, const char *table);

#endif
