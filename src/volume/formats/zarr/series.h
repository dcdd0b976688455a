/* volume/formats/zarr/series.h - finds the images of a collection. The images are the series of
 * bioformats2raw, or the fields of a plate's wells. */
#ifndef HL_VOLUME_ZARR_SERIES_H
#define HL_VOLUME_ZARR_SERIES_H

#include "volume/formats/zarr/image.h"

/* Lists the collection's images in the request, and sets `folder` to the folder of the wanted image: the
 * image that the request names by its number (from 0), path or name, or else the first image. *is_collection:
 * set to false if `ome` describes no collection. */
hl_status hl_zarr_series_choose(const hl_bundle *bundle, const json_t *ome, hl_load_request *request,
                                char folder[HL_ZARR_PATH_BYTES], bool *is_collection, hl_error *error);

#endif
