/* volume/formats/zarr/description.h - reads OME-Zarr's descriptions of channels, labels and label maps. */
#ifndef HL_VOLUME_ZARR_DESCRIPTION_H
#define HL_VOLUME_ZARR_DESCRIPTION_H

#include "volume/formats/zarr/metadata.h"

/* Reads names, colours and windows of channels from the attribute "omero", which says how a viewer should
 * show channels, and selects the channel that the caller has named. request->selection must be set. */
hl_status hl_zarr_describe_channels(const json_t *ome, const char *path, hl_load_request *request,
                                    hl_error *error);

/* Reads the colours and the names of labels that an image of labels states. The name of a label is its
 * property "class", "name" or "label". */
hl_status hl_zarr_name_labels(const json_t *ome, hl_volume *volume, hl_error *error);

/* Lists the images of labels that belong to an image. The images of labels are in the group "labels" of the
 * image's group. If that group cannot be read, the list is empty. */
hl_status hl_zarr_list_label_maps(const hl_bundle *bundle, const char *folder, hl_volume *volume,
                                  hl_error *error);

#endif
