/* start/plane_histogram.h - makes a two-dimensional histogram of a volume, by value and gradient. */
#ifndef HL_START_PLANE_HISTOGRAM_H
#define HL_START_PLANE_HISTOGRAM_H

#include <stdio.h>

#include <halflight/halflight.h>

/* Writes the numbers of voxels for each value and gradient as JSON: {"gradient": the greatest gradient in the
 * histogram, "columns" of values over the volume's range, "rows" of gradients from 0, "counts":
 * [row][column]}; writes null if memory is short. */
void put_plane_histogram(FILE *out, const hl_volume *volume, const hl_volume_info *info);

#endif
