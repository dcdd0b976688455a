/* volume/zarr/voxels.h - the voxels of a part of a Zarr array, from its chunks. */
#ifndef HL_VOLUME_ZARR_VOXELS_H
#define HL_VOLUME_ZARR_VOXELS_H

#include "volume/zarr/array.h"

/* Which of the array's axes are the volume's, and the index along all others. */
typedef struct hl_zarr_choice {
  int axis[3];                       /* of i, j, k; -1: none, a single voxel */
  uint64_t index[HL_ZARR_AXES_MOST]; /* along axes that are not in `axis` */
} hl_zarr_choice;

/* Reads *voxels, [k][j][i] in stored form, owned by the caller. Fails if all chunks are missing. */
hl_status hl_zarr_voxels_read(const hl_bundle *bundle, const hl_zarr_array *array,
                              const hl_zarr_choice *choice, void **voxels, hl_error *error);

#endif
