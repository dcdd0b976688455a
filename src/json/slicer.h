/* json/slicer.h - volume properties of 3D Slicer. What is made is owned by *function, after a failure too. */
#ifndef HL_JSON_SLICER_H
#define HL_JSON_SLICER_H

#include "json/parts.h"

/* An object with "volumeProperties". volume: what the function is for; of several components' functions, its
 * component's are read. Null: none is known. */
hl_status hl_json_read_slicer(hl_json_reader *reader, const json_t *root, const hl_volume *volume,
                              hl_transfer_function *function);

/* Whether a path names a text of Slicer's: NAME.vp, NAME.xml (of one preset) or NAME.xml:PRESET. */
bool hl_slicer_is_text(const char *path);

/* Reads such a text. Errors name path. */
hl_status hl_slicer_read_text(hl_context *context, const char *path, hl_transfer_function *function,
                              hl_error *error);

/* Takes opacity by gradient away where it is 1 everywhere. */
void hl_slicer_drop_even_gradient(hl_context *context, hl_transfer_function *function);

/* Slicer's lengths of gradients are per mean voxel edge, and what holds at a quarter of the range of values
 * holds beyond it, as in VTK (vtkFixedPointVolumeRayCastMapper). Converts the lengths to those per world
 * unit. */
void hl_slicer_fit_gradient(const hl_volume *volume, hl_transfer_function *function);

#endif
