/* volume/load_beside.h - loads a label map that lies over a volume. */
#ifndef HL_VOLUME_LOAD_BESIDE_H
#define HL_VOLUME_LOAD_BESIDE_H

#include <halflight/volume.h>

/* Loads a volume as hl_volume_load_with() does. Files of bare voxels tell no spacing, so that the user states
 * one for the volume. This spacing also holds for a label map over the volume if the map has the same number
 * of voxels along each axis, and no spacing in its own options. volume: may be null. spacing: the stated
 * spacing; 0 if there is none. options->spacing is set to the spacing by which the map was read. */
hl_status hl_volume_load_beside(hl_context *context, const char *path, const hl_volume *volume,
                                const double spacing[3], hl_volume_load_options *options, hl_volume **map,
                                hl_error *error);

#endif
