/* volume/formats/zarr/array_read.h - reads the metadata of a Zarr array. */
#ifndef HL_VOLUME_ZARR_ARRAY_READ_H
#define HL_VOLUME_ZARR_ARRAY_READ_H

#include "volume/formats/zarr/array.h"

/* Reads the metadata of the array in `folder` ("" or ending with '/'). *found: set to false if the folder has
 * no array. */
hl_status hl_zarr_array_read(const hl_bundle *bundle, const char *folder, hl_zarr_array *array, bool *found,
                             hl_error *error);

#endif
