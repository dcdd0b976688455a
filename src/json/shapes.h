/* json/shapes.h - volumes made of shapes, from JSON and back. */
#ifndef HL_JSON_SHAPES_H
#define HL_JSON_SHAPES_H

#include "json/read.h"

#include <halflight/shape.h>

#define HL_SHAPES_DEEPEST 32 /* groups within groups */

/* The volume of the keys "shapes" and "voxel_size" of an object; groups: the object that names groups, or
 * null. *volume is owned by the caller; *voxel_size gets the one used. */
hl_status hl_json_read_shapes(hl_json_reader *reader, const json_t *object, const json_t *groups,
                              const hl_shapes_options *options, hl_volume **volume, double *voxel_size);

/* Every group of "groups" that no shape may name is read too, so that faults in it show. */
hl_status hl_json_check_groups(hl_json_reader *reader, const json_t *groups);

/* A list of shapes in which named groups hold their shapes themselves: owned by the caller (json_decref);
 * null for a list that hl_json_read_shapes() would refuse, or without memory. */
json_t *hl_json_expand_shapes(const json_t *shapes, const json_t *groups);

/* {"shapes": expanded, "voxel_size": h} as text, owned by the caller (hl_release); null without memory. */
char *hl_json_shapes_text(hl_context *context, const json_t *shapes, const json_t *groups, double voxel_size);

#endif
