/* volume/statistics.h - finds range, mean, histogram and number of non-finite voxels of a volume. */
#ifndef HL_VOLUME_STATISTICS_H
#define HL_VOLUME_STATISTICS_H

#include "volume/volume.h"

/* Sets minimum, maximum, mean, nonfinite_count and histogram from the voxels. subject: starts the error
 * lines. */
hl_status hl_volume_measure(hl_volume *volume, const char *subject, hl_error *error);

#endif
