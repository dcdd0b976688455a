/* volume/zarr/voxels.h - the voxels of a part of a Zarr array, from its chunks. */
#ifndef HL_VOLUME_ZARR_VOXELS_H
#define HL_VOLUME_ZARR_VOXELS_H

#include "volume/destination.h"
#include "volume/zarr/array.h"

/* Which of the array's axes are the volume's, and the index along all others. */
typedef struct hl_zarr_choice {
  int axis[3];                       /* of i, j, k; -1: none, a single voxel */
  uint64_t index[HL_ZARR_AXES_MOST]; /* along axes that are not in `axis` */
} hl_zarr_choice;

/* Opens the destination and reads all voxels into it; fails if all chunks are missing. grid: the volume's, as
 * the choice makes it. Close the destination in any case; it is of zeros before. */
hl_status hl_zarr_voxels_read(const hl_bundle *bundle, const hl_zarr_array *array,
                              const hl_zarr_choice *choice, const hl_volume_description *grid,
                              hl_destination *to, hl_error *error);

#endif
