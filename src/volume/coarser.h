/* volume/coarser.h - makes a volume at half the resolution of another volume. */
#ifndef HL_VOLUME_COARSER_H
#define HL_VOLUME_COARSER_H

#include "volume/volume.h"

/* The ways in which voxels are merged. HL_COARSER_MEANS: the result is the mean of the finite values, rounded
 * if values are whole numbers. HL_COARSER_LABELS: the result is the most common label; if several labels are
 * equally common, the result is the first of them. */
typedef enum hl_coarser_kind { HL_COARSER_MEANS, HL_COARSER_LABELS } hl_coarser_kind;

/* Makes a coarser volume by merging pairs of voxels along its axes. Only axes whose step is less than 1.5
 * times the shortest step are halved. In a field in bricks, the finest level is left out, which halves all
 * axes (bricks/coarser.h). Fields in bricks cannot have labels. Refuses volumes of colours, volumes over
 * ranks, and label maps whose numbers floats round (volume/exact.h). */
hl_status hl_volume_make_coarser(const hl_volume *volume, hl_coarser_kind kind, hl_volume **coarser,
                                 hl_error *error);

#endif
