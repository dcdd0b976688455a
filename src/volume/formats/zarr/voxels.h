/* volume/formats/zarr/voxels.h - reads the voxels of a part of a Zarr array from its chunks. */
#ifndef HL_VOLUME_ZARR_VOXELS_H
#define HL_VOLUME_ZARR_VOXELS_H

#include "volume/beyond.h"
#include "volume/formats/zarr/array.h"
#include "volume/io/destination.h"

/* The part of an array that becomes the volume: the array's axes that are the volume's axes, and the index
 * that is read along each other axis. */
typedef struct hl_zarr_choice {
  int axis[3];                       /* for each of i, j, k, the index of the array's axis; -1 if the array
                                      * lacks this axis, so that the volume has a single voxel along it */
  uint64_t index[HL_ZARR_AXES_MOST]; /* for each axis of the array that is not in `axis`, the index that is
                                      * read */
  hl_beyond beyond;                  /* the rule by which chunks out of sight are not read */
} hl_zarr_choice;

/* Opens the destination and reads all voxels into it. Fails if all chunks are missing. grid: the volume's
 * grid, which must fit the choice. *to: must be zero before the call; the caller closes it, also after a
 * failure. *absence: set to the number of chunks that a server lacks, and to the number of all chunks; not
 * changed if the store is a folder or an archive. */
hl_status hl_zarr_voxels_read(const hl_bundle *bundle, const hl_zarr_array *array,
                              const hl_zarr_choice *choice, const hl_volume_description *grid,
                              hl_destination *to, hl_absence *absence, bool *is_part, hl_error *error);

#endif
