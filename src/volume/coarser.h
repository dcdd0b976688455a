/* volume/coarser.h - a volume at half its resolution. */
#ifndef HL_VOLUME_COARSER_H
#define HL_VOLUME_COARSER_H

#include "volume/volume.h"

/* How voxels are merged: HL_COARSER_MEANS: to the mean of their finite values, rounded where values are
 * whole numbers; HL_COARSER_LABELS: to the label that most of them have, the first of equally common
 * labels. */
typedef enum hl_coarser_kind { HL_COARSER_MEANS, HL_COARSER_LABELS } hl_coarser_kind;

/* Makes a volume by merging two voxels along each short axis: an axis along which voxels are at most 1.5
 * times as long as along the axis with the shortest ones. A field in bricks, which has no labels, is made
 * coarser along all axes: its finest level is left out (bricks/coarser.h). Volumes of colours and volumes
 * over ranks are not allowed, nor are maps of labels with numbers that floats round (volume/exact.h). */
hl_status hl_volume_make_coarser(const hl_volume *volume, hl_coarser_kind kind, hl_volume **coarser,
                                 hl_error *error);

#endif
