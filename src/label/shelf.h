/* label/shelf.h - occupancies that stay with their label map, from scene to scene. */
#ifndef HL_LABEL_SHELF_H
#define HL_LABEL_SHELF_H

#include "label/occupancy.h"

/* The occupancies of labels: those that were made of the map before, and hl_label_occupancy() of the others,
 * after one pass over the map for all of them. labels: [count]; data values, rising. made: [count]; retained
 * for the caller; null where no voxel has the label; all null after a failure. threads: 0: one per processor.
 * Any thread may call it. */
hl_status hl_label_occupancies(hl_context *context, int threads, hl_volume *map, const double *labels,
                               size_t count, hl_volume **made, hl_error *error);

#endif
