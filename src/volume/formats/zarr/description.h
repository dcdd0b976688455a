/* volume/formats/zarr/description.h - OME-Zarr's descriptions of channels, labels and label maps. */
#ifndef HL_VOLUME_ZARR_DESCRIPTION_H
#define HL_VOLUME_ZARR_DESCRIPTION_H

#include "volume/formats/zarr/metadata.h"

/* Reads names, colours and windows of channels, from the attribute "omero", which says how a viewer should
 * show them. The request's selection must be made. */
hl_status hl_zarr_describe_channels(const json_t *ome, hl_load_request *request, hl_error *error);

/* Reads the labels of an image of labels: their colours, and their names from the property "class", "name" or
 * "label". */
hl_status hl_zarr_name_labels(const json_t *ome, hl_volume *volume, hl_error *error);

/* Lists the images of labels in the group "labels" of an image's group. A group that cannot be read lists
 * none. */
hl_status hl_zarr_list_label_maps(const hl_bundle *bundle, const char *folder, hl_volume *volume,
                                  hl_error *error);

#endif
