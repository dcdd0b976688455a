/* label/occupancy.h - a label of a label map as a smooth field whose surface is where its own is.
 *
 * A label map's voxels are the numbers of things. The occupancy of a label is 1 within it and 0
 * outside, without the stairs of the voxels: reconstructed by the B-spline, it passes 1/2 at its surface.
 */
#ifndef HL_LABEL_OCCUPANCY_H
#define HL_LABEL_OCCUPANCY_H

#include "core/pool.h"
#include "volume/volume.h"

/* The part of a map's grid that holds a label, with a margin for its smooth surface. */
typedef struct hl_label_part {
  size_t first[3], size[3]; /* voxels along i, j, k; a size of 0: no voxel has the label */
} hl_label_part;

/* Finds the parts of several labels in one pass over the map. labels: [count]; data values, rising; parts:
 * [count]. */
hl_status hl_label_parts(hl_context *context, hl_pool *pool, const hl_volume *map, const double *labels,
                         size_t count, hl_label_part *parts, hl_error *error);

/* Makes the occupancy of a label over its part. *made is null where no voxel has the label. Memory: five
 * bytes a voxel of the part, one of which stays. */
hl_status hl_label_occupancy(hl_context *context, hl_pool *pool, const hl_volume *map, double label,
                             const hl_label_part *part, hl_volume **made, hl_error *error);

#endif
