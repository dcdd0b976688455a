/* scene/label/label_table.h - reads names and colours of labels from a file: FreeSurfer's and Slicer's colour
 * tables, ITK-SNAP's label descriptions, or CSV. */
#ifndef HL_SCENE_LABEL_LABEL_TABLE_H
#define HL_SCENE_LABEL_LABEL_TABLE_H

#include <halflight/scene.h>

#include "core/error.h"
#include "core/vector.h"

enum { HL_MOST_LABELS = 16384 };

/* Labels with their names in one block; owned (hl_label_list_release). */
typedef struct hl_label_list {
  hl_label *labels; /* [count]; the labels, rising by value */
  size_t count;
  char *names; /* the block of memory in which the labels' names lie */
} hl_label_list;

/* Finds a label by its value. labels: [count], rising by value. Returns null if the list has no such label.
 */
const hl_label *hl_label_of_value(const hl_label *labels, size_t count, double value);

/* Finds the factor by which a mask multiplies extinction at a place, by the map's voxel that is nearest to
 * the place. The renderer's factor differs from this factor beside the borders of labels, where the
 * renderer's factor is smooth and passes 1/2. mask: must have a volume, whose voxels must be at hand. place:
 * in the index space of the mask's volume. */
double hl_mask_factor(const hl_mask *mask, vec3 place);

/* Reads a table of labels from a file. Lines are "number name R G B [A]", "number R G B A visible mesh
 * \"name\"", or one of these forms with commas. Colours are sRGB, with numbers from 0 to 255. If no number of
 * a colour is above 1 and at least one number has a decimal point, the numbers go from 0 to 1. Lines that
 * begin with #, and a first line without a number, are skipped. */
hl_status hl_label_table_load(hl_context *context, const char *path, hl_label_list *list, hl_error *error);
/* Reads a table of labels from memory. name: the text's name in errors. */
hl_status hl_label_table_parse(hl_context *context, const char *text, size_t length, const char *name,
                               hl_label_list *list, hl_error *error);
void hl_label_list_release(hl_context *context, hl_label_list *list);

/* Makes a colour from a label's number, so that different labels have different colours. Hues of consecutive
 * labels are a golden angle apart. */
void hl_label_distinct_color(int64_t value, double linear[3]);

#endif
