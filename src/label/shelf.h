/* label/shelf.h - describes the shelf of a label map: the map's occupancies, its last mask and its last solid
 * volume, which are kept from scene to scene. */
#ifndef HL_LABEL_SHELF_H
#define HL_LABEL_SHELF_H

#include <halflight/scene.h>

#include "label/occupancy.h"

/* Gets the occupancies of labels. Occupancies that were made of the map before are taken from the shelf.
 * hl_label_occupancy() makes the other occupancies; the boxes that hold the labels are found in one pass over
 * the map. labels: [count]; data values, rising. made: [count]; retained for the caller; an element is null
 * if no voxel has the label; all are null after a failure. threads: 0 for one per processor. work: receives
 * the voxels of all these labels' boxes; null if progress is to be reported for these labels alone. Any
 * thread may call this function. */
hl_status hl_label_occupancies(hl_context *context, int threads, hl_volume *map, const int64_t *labels,
                               size_t count, hl_label_work *work, hl_volume **made, hl_error *error);

/* Looks on the shelf of the mask's map for the lattice that was made last. Returns it, retained, if it was
 * made of the same labels and the same `rest`; else null. Any thread may call this function. */
hl_volume *hl_mask_from_shelf(const hl_mask *mask);
/* Keeps the lattice of a mask on the shelf of its map, in place of the lattice kept before. If memory is
 * short, the lattice is not kept. */
void hl_mask_to_shelf(const hl_mask *mask, hl_volume *made);

/* Looks on the map's shelf for the solid volume that was made last. Returns it, retained, if it was made of
 * the same labels; else null. */
hl_volume *hl_solids_from_shelf(hl_volume *map, const hl_label *labels, size_t count);
void hl_solids_to_shelf(hl_volume *map, const hl_label *labels, size_t count, hl_volume *made);

#endif
