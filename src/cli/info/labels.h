/* cli/info/labels.h - prints the labels of a label map: their names, voxels and volumes. */
#ifndef HL_CLI_INFO_LABELS_H
#define HL_CLI_INFO_LABELS_H

#include <halflight/halflight.h>

#include "cli/json_writer.h"

/* Prints the labels. json: the writer to which a list is added; if null, text is printed. unit: the unit of
 * lengths; null if it is not known. table: a table of
 * names; null if there is none. */
hl_status info_tell_labels(hl_context *context, json_writer *json, const hl_volume *map, const char *unit,
                           const char *table, hl_error *error);

#endif
