/* json/shapes.h - reading and writing volumes made of shapes. */
#ifndef HL_JSON_SHAPES_H
#define HL_JSON_SHAPES_H

#include "json/read.h"

#include <halflight/shape.h>

#define HL_SHAPES_DEEPEST 32 /* groups within groups */

/* Makes a volume by an object's keys "shapes" and "voxel_size". groups: the scene's "groups", or null.
 * *volume is owned by the caller; *voxel_size becomes the voxel size used. */
hl_status hl_json_read_shapes(hl_json_reader *reader, const json_t *object, const json_t *groups,
                              const hl_shapes_options *options, hl_volume **volume, double *voxel_size);

/* Checks every group of "groups", those that no shape names too. */
hl_status hl_json_check_groups(hl_json_reader *reader, const json_t *groups);

/* A copy of a list of shapes in which each group holds its shapes instead of a name; owned by the caller
 * (json_decref). Null for a list that hl_json_read_shapes() would refuse, or without memory. */
json_t *hl_json_expand_shapes(const json_t *shapes, const json_t *groups);

/* {"shapes": [...], "voxel_size": h} as text, with groups expanded; owned by the caller (hl_release). Null
 * without memory. */
char *hl_json_shapes_text(hl_context *context, const json_t *shapes, const json_t *groups, double voxel_size);

#endif
