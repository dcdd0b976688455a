/* cli/info/labels.h - prints the labels of a label map: their names, and how many voxels each has. */
#ifndef HL_CLI_INFO_LABELS_H
#define HL_CLI_INFO_LABELS_H

#include <halflight/halflight.h>

#include "cli/json_writer.h"

/* Prints the labels. json: the writer to which a list is added; if null, text is printed. table: a table of
 * names; null if there is none. */
hl_status info_tell_labels(hl_context *context, json_writer *json, const hl_volume *map, const char *table,
                           hl_error *error);

#endif
