/* json/shapes.h - reads and writes volumes that are made of shapes. */
#ifndef HL_JSON_SHAPES_H
#define HL_JSON_SHAPES_H

#include "json/read.h"

#include <halflight/shape.h>

#define HL_SHAPES_DEEPEST 32 /* greatest depth of groups within groups */

/* Makes a volume by an object's keys "shapes" and "voxel_size". groups: the scene's "groups", or null.
 * *volume: owned by the caller. *voxel_size: receives the edge of voxels that was used. */
hl_status hl_json_read_shapes(hl_json_reader *reader, const json_t *object, const json_t *groups,
                              const hl_shapes_options *options, hl_volume **volume, double *voxel_size);

/* Checks every group in a scene's "groups", including groups that no shape names. */
hl_status hl_json_check_groups(hl_json_reader *reader, const json_t *groups);

/* A copy of a list of shapes in which each named group is replaced by its shapes. The copy is owned by the
 * caller (json_decref). Null if hl_json_read_shapes() would refuse the list, or if memory is short. */
json_t *hl_json_expand_shapes(const json_t *shapes, const json_t *groups);

/* Writes shapes as the text {"shapes": [...], "voxel_size": h}, in which each named group is replaced by its
 * shapes. Owned by the caller (hl_release); null if memory is short. */
char *hl_json_shapes_text(hl_context *context, const json_t *shapes, const json_t *groups, double voxel_size);

#endif
