/* start/plane_histogram.h - how many voxels have a value and a gradient. */
#ifndef HL_START_PLANE_HISTOGRAM_H
#define HL_START_PLANE_HISTOGRAM_H

#include <stdio.h>

#include <halflight/halflight.h>

/* Writes how many voxels have a value and a gradient: {"gradient": the greatest that is drawn, "columns" of
 * values over the volume's range, "rows" of gradients from 0, "counts": [row][column]}; null without memory.
 */
void put_plane_histogram(FILE *out, const hl_volume *volume, const hl_volume_info *info);

#endif
