/* golden/volumes.h - the small volumes that the golden scenes show. */
#ifndef GOLDEN_VOLUMES_H
#define GOLDEN_VOLUMES_H

#include <stdbool.h>

/* Writes all volumes as files into a folder; false if one cannot be written. Their names:
 *     ball_24x24x24_uint8.raw      a ball with a soft edge
 *     stage_32x32x32_uint8.raw     a floor (80), a ball above it (160) and a post (240)
 *     waves.nrrd                   a smooth float field from 0 to 1 on an oblique grid of 26 x 22 x 18
 * unequal voxels
 */
bool volumes_write(const char *folder);

#endif
