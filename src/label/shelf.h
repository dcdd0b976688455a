/* label/shelf.h - occupancies and the last mask, which stay with their label map from scene to scene. */
#ifndef HL_LABEL_SHELF_H
#define HL_LABEL_SHELF_H

#include <halflight/scene.h>

#include "label/occupancy.h"

/* The occupancies of labels: those that were made of the map before, and hl_label_occupancy() of the others,
 * after one pass over the map for all of them. labels: [count]; data values, rising. made: [count]; retained
 * for the caller; null where no voxel has the label; all null after a failure. threads: 0: one per processor.
 * Any thread may call it. */
hl_status hl_label_occupancies(hl_context *context, int threads, hl_volume *map, const double *labels,
                               size_t count, hl_volume **made, hl_error *error);

/* The lattice that was made last of the mask's map, retained, if it was made of the same labels and rest;
 * else null. Any thread may call it. */
hl_volume *hl_mask_from_shelf(const hl_mask *mask);
/* Keeps a lattice, in place of the one before. Without memory it is not kept. */
void hl_mask_to_shelf(const hl_mask *mask, hl_volume *made);

/* The same for what was made last of solid labels. */
hl_volume *hl_solids_from_shelf(hl_volume *map, const hl_label *labels, size_t count);
void hl_solids_to_shelf(hl_volume *map, const hl_label *labels, size_t count, hl_volume *made);

#endif
