/* json/foreign/slicer.h - volume properties of 3D Slicer. The content is owned by *function, also after a
 * failure. */
#ifndef HL_JSON_FOREIGN_SLICER_H
#define HL_JSON_FOREIGN_SLICER_H

#include "json/parts.h"

/* Reads an object with "volumeProperties". volume: the volume that the function is for; where there are
 * functions for several components, those of the volume's component are read. Null if the volume is not
 * known. */
hl_status hl_json_read_slicer(hl_json_reader *reader, const json_t *root, const hl_volume *volume,
                              hl_transfer_function *function);

/* Whether a path names a text of Slicer's: NAME.vp, NAME.xml (of one preset) or NAME.xml:PRESET. */
bool hl_slicer_is_text(const char *path);

/* Reads a text of Slicer's. Errors name path. */
hl_status hl_slicer_read_text(hl_context *context, const char *path, hl_transfer_function *function,
                              hl_error *error);

/* Removes opacity by gradient that is 1 everywhere. */
void hl_slicer_drop_even_gradient(hl_context *context, hl_transfer_function *function);

/* Converts Slicer's lengths of gradients to lengths per world unit. Slicer's lengths are per mean voxel edge.
 * Opacity at a quarter of the range of values holds for greater lengths, too, as in VTK
 * (vtkFixedPointVolumeRayCastMapper). */
void hl_slicer_fit_gradient(const hl_volume *volume, hl_transfer_function *function);

#endif
