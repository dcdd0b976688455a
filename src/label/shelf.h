/* label/shelf.h - occupancies that stay with their label map, from scene to scene. */
#ifndef HL_LABEL_SHELF_H
#define HL_LABEL_SHELF_H

#include "label/occupancy.h"

/* hl_label_occupancy(), or the one that was made of the map before. *made is retained for the caller; null
 * where no voxel has one of the labels. threads: 0: one per processor. Any thread may call it. */
hl_status hl_label_occupancy_of(hl_context *context, int threads, hl_volume *map, hl_label_values labels,
                                hl_volume **made, hl_error *error);

#endif
