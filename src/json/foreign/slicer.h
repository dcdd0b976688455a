/* json/foreign/slicer.h - reads volume properties of 3D Slicer as transfer functions. *function owns the
 * content that was read, also after a failure. */
#ifndef HL_JSON_FOREIGN_SLICER_H
#define HL_JSON_FOREIGN_SLICER_H

#include "json/parts.h"

/* Reads an object with "volumeProperties". volume: the volume for which the function is read; null if it is
 * not known. If the object has functions for several components, the functions of the volume's component are
 * read. */
hl_status hl_json_read_slicer(hl_json_reader *reader, const json_t *root, const hl_volume *volume,
                              hl_transfer_function *function);

/* Returns whether a path names a file of Slicer's text formats: NAME.vp, NAME.xml (with one preset) or
 * NAME.xml:PRESET. */
bool hl_slicer_is_text(const char *path);

/* Reads a transfer function from a file of Slicer's text formats. Errors name `path`. */
hl_status hl_slicer_read_text(hl_context *context, const char *path, hl_transfer_function *function,
                              hl_error *error);

/* Removes opacity by gradient that is 1 everywhere. */
void hl_slicer_drop_even_gradient(hl_context *context, hl_transfer_function *function);

/* Converts a function's gradients from Slicer's unit, data values per mean voxel edge, to data values per
 * world unit. The opacity at a quarter of the range of values is also used for all greater gradients, as in
 * VTK (vtkFixedPointVolumeRayCastMapper). */
void hl_slicer_fit_gradient(const hl_volume *volume, hl_transfer_function *function);

#endif
