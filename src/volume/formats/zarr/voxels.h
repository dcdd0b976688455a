/* volume/formats/zarr/voxels.h - reads the voxels of a part of a Zarr array from its chunks. */
#ifndef HL_VOLUME_ZARR_VOXELS_H
#define HL_VOLUME_ZARR_VOXELS_H

#include "volume/formats/zarr/array.h"
#include "volume/io/destination.h"

/* The array's axes that are the volume's axes, and the index along all others. */
typedef struct hl_zarr_choice {
  int axis[3];                       /* the array's axis for each of i, j, k; -1: there is none, and the
                                      * volume has a single voxel along it */
  uint64_t index[HL_ZARR_AXES_MOST]; /* index along the axes that are not in `axis` */
} hl_zarr_choice;

/* Opens the destination and reads all voxels into it. Fails if all chunks are missing. grid: the volume's
 * grid, as the choice makes it. The destination must be zero before. Close it also after a failure. */
hl_status hl_zarr_voxels_read(const hl_bundle *bundle, const hl_zarr_array *array,
                              const hl_zarr_choice *choice, const hl_volume_description *grid,
                              hl_destination *to, hl_error *error);

#endif
