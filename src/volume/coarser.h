/* volume/coarser.h - a volume at half its resolution. */
#ifndef HL_VOLUME_COARSER_H
#define HL_VOLUME_COARSER_H

#include "volume/volume.h"

/* What takes the place of the voxels that are merged: their mean, over the finite values and rounded where
 * values are whole numbers; or the label that most of them have, and of equally common ones the first. */
typedef enum hl_coarser_kind { HL_COARSER_MEANS, HL_COARSER_LABELS } hl_coarser_kind;

/* Makes a volume whose voxels are merged of two voxels along the axes whose voxels are short: those that are
 * less than 1.5 times as long as the shortest. A field in bricks, which has no labels, is made coarser along
 * all axes, by leaving its finest level out (bricks/coarser.h). The volume is not of colours and not over
 * ranks, and a map of labels has no numbers that floats round (volume/exact.h). */
hl_status hl_volume_make_coarser(const hl_volume *volume, hl_coarser_kind kind, hl_volume **coarser,
                                 hl_error *error);

#endif
