/* scene/labels.h - are a volume's values names of regions? */
#ifndef HL_SCENE_LABELS_H
#define HL_SCENE_LABELS_H

#include "scene/automatic.h"

/* Where the volume is a label map, its kind becomes HL_DATA_LABELS and its labels are listed; else nothing
 * changes. A label map has whole numbers, at most HL_MOST_LABELS beside the background and at least two, and
 * most of them lie in blocks: a voxel's neighbours mostly have its own value. Fails for lack of memory. */
hl_status hl_data_find_labels(const hl_volume *volume, hl_data_analysis *analysis, hl_error *error);

#endif
