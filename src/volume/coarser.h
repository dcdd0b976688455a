/* volume/coarser.h - a volume at half its resolution. */
#ifndef HL_VOLUME_COARSER_H
#define HL_VOLUME_COARSER_H

#include "volume/volume.h"

/* Makes a volume whose voxels are means of two voxels along the axes whose voxels are short: those that are
 * less than 1.5 times as long as the shortest. A mean is over the finite values; values of whole numbers are
 * rounded. A field in bricks is made coarser along all axes, by leaving its finest level out
 * (bricks/coarser.h). The volume is of values, not of labels or colours, and not over ranks. */
hl_status hl_volume_make_coarser(const hl_volume *volume, hl_volume **coarser, hl_error *error);

#endif
