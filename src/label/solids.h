/* label/solids.h - labels that are solid together, as one volume.
 *
 * Two labels that touch have each a rounded field of its own: drawn side by side they leave a groove. What is
 * solid together has one field, and its surface, normals and shadows are those of all labels as one body.
 * Colours tell the labels apart. */
#ifndef HL_LABEL_SOLIDS_H
#define HL_LABEL_SOLIDS_H

#include <halflight/scene.h>

#include "core/error.h"

/* Makes the occupancy (occupancy.h) of all labels together, with the colours of each: the volume's own
 * (volume/colors.h), which run over into each other within about a voxel and a half where labels meet. Labels
 * of one colour give a volume without colours. labels: [count]; solid ones, rising by value. *made is
 * retained for the caller; null where no voxel has one of the labels. threads: 0: one per processor. */
hl_status hl_label_solids(hl_context *context, int threads, hl_volume *map, const hl_label *labels,
                          size_t count, hl_volume **made, hl_error *error);

#endif
