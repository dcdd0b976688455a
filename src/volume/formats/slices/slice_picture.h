/* volume/formats/slices/slice_picture.h - decodes one picture of a folder of slices from memory: PNG, JPEG,
 * the first page of a TIFF file, or bare voxels. */
#ifndef HL_VOLUME_SLICE_PICTURE_H
#define HL_VOLUME_SLICE_PICTURE_H

#include "volume/formats/slices/slice_codecs.h"

/* Returns whether a file's name is the name of a picture that can be a slice. */
bool hl_slice_is_named(const char *name);

/* Reads a picture's header. Refuses a file that is too short for the picture's size. */
hl_status hl_slice_measure(const hl_slice_file *file, hl_slice_shape *shape, hl_error *error);

/* Decodes a picture into width x height stored voxels, or into colours (colors.h). component: an index or an
 * HL_COMPONENT_ value. The picture's own shape must equal `shape`. */
hl_status hl_slice_decode(const hl_slice_file *file, const hl_slice_shape *shape, int component, void *voxels,
                          hl_error *error);

#endif
