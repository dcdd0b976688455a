/* volume/zarr/description.h - what OME-Zarr tells beside the voxels: of channels, of labels, of label maps.
 */
#ifndef HL_VOLUME_ZARR_DESCRIPTION_H
#define HL_VOLUME_ZARR_DESCRIPTION_H

#include "volume/zarr/metadata.h"

/* Names, colours and windows of channels, as a viewer is to show them ("omero"). The request's selection is
 * made. */
hl_status hl_zarr_describe_channels(const json_t *ome, hl_load_request *request, hl_error *error);

/* The labels of an image of labels: their colours, and names by the property "class", "name" or "label". */
hl_status hl_zarr_name_labels(const json_t *ome, hl_volume *volume, hl_error *error);

/* The images of labels that the group "labels" of an image's group lists. A group that cannot be read lists
 * none. */
hl_status hl_zarr_list_label_maps(const hl_bundle *bundle, const char *folder, hl_volume *volume,
                                  hl_error *error);

#endif
