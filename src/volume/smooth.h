/* volume/smooth.h - voxels smoothed by a Gaussian. */
#ifndef HL_VOLUME_SMOOTH_H
#define HL_VOLUME_SMOOTH_H

#include "volume/volume.h"

/* Makes a volume of the values of another one, convolved with a Gaussian whose standard deviation is sigma
 * voxels along each axis, above 0 (equations: smoothing). Voxels beyond the volume's border count as equal to
 * the nearest voxel at the border. Voxels that are not finite are not changed, and do not affect other
 * voxels. The volume must be in memory. *smoothed is owned by the caller. */
hl_status hl_volume_convolve(const hl_volume *volume, double sigma, hl_volume **smoothed, hl_error *error);

/* The greatest number of bytes that hl_volume_convolve() allocates beside the volume, for any sigma. */
uint64_t hl_volume_convolve_bytes(const hl_volume *volume);

#endif
