/* label/occupancy.h - labels of a label map as a smooth field whose surface is where theirs is.
 *
 * A label map's voxels are the numbers of things. The occupancy of some labels is 1 within them and 0
 * outside, without the stairs of the voxels: reconstructed by the B-spline, it passes 1/2 at their surface.
 */
#ifndef HL_LABEL_OCCUPANCY_H
#define HL_LABEL_OCCUPANCY_H

#include "core/pool.h"
#include "volume/volume.h"

/* Labels, as data values. */
typedef struct hl_label_values {
  const double *values; /* [count]; rising */
  size_t count;
} hl_label_values;

/* Makes the occupancy of the labels, over the part of the grid that holds them. *made is null where no voxel
 * has one of the labels. Memory: five bytes a voxel of that part, one of which stays. */
hl_status hl_label_occupancy(hl_context *context, hl_pool *pool, const hl_volume *map, hl_label_values labels,
                             hl_volume **made, hl_error *error);

#endif
