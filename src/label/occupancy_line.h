/* label/occupancy_line.h - computes the occupancy of a label (occupancy.h) at the voxels of the label map. */
#ifndef HL_LABEL_OCCUPANCY_LINE_H
#define HL_LABEL_OCCUPANCY_LINE_H

#include "volume/volume.h"

/* Finds where an occupancy's first voxel lies in the map. */
void hl_occupancy_first(const hl_volume *map, const hl_volume *occupancy, size_t first[3]);

/* Computes the occupancy at the voxels of one of its lines, [dimension 0]: the B-spline's value at the
 * voxels' centres. */
void hl_occupancy_line(const hl_volume *occupancy, size_t j, size_t k, float *line);

#endif
