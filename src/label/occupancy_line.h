/* label/occupancy_line.h - the occupancy of a label (occupancy.h) at the voxels of the label map. */
#ifndef HL_LABEL_OCCUPANCY_LINE_H
#define HL_LABEL_OCCUPANCY_LINE_H

#include "volume/volume.h"

/* The place of an occupancy's first voxel in the map. */
void hl_occupancy_first(const hl_volume *map, const hl_volume *occupancy, size_t first[3]);

/* The occupancy at the voxels of one of its lines, [dimension 0]: the B-spline's value at their centres. */
void hl_occupancy_line(const hl_volume *occupancy, size_t j, size_t k, float *line);

#endif
