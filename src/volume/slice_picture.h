/* volume/slice_picture.h - one picture of a folder of slices, decoded from memory: PNG, JPEG, or the first
 * page of a TIFF file. */
#ifndef HL_VOLUME_SLICE_PICTURE_H
#define HL_VOLUME_SLICE_PICTURE_H

#include "volume/volume.h"

/* A picture file in memory. */
typedef struct hl_slice_file {
  hl_context *context;
  const char *path; /* for error lines */
  const unsigned char *bytes;
  size_t length;
} hl_slice_file;

typedef struct hl_slice_shape {
  size_t width, height, samples; /* samples of a pixel */
  hl_voxel_type type;
} hl_slice_shape;

/* Whether a file's name promises a picture that can be a slice. */
bool hl_slice_is_named(const char *name);

/* Reads a picture's header, and refuses pictures that the file is too short for. */
hl_status hl_slice_measure(const hl_slice_file *file, hl_slice_shape *shape, hl_error *error);

/* Decodes a picture's component, or HL_COMPONENT_MAGNITUDE, into width x height stored voxels. The picture's
 * shape must be `shape`. */
hl_status hl_slice_decode(const hl_slice_file *file, const hl_slice_shape *shape, int component, void *voxels,
                          hl_error *error);

typedef enum hl_slice_stack {
  HL_SLICE_ALONE,
  HL_SLICE_STACK, /* TIFF of several pages: a volume of its own */
  HL_SLICE_OF_OME /* OME-TIFF, which names all files of its volume */
} hl_slice_stack;

hl_status hl_slice_find_stack(const hl_slice_file *file, hl_slice_stack *stack, hl_error *error);

#endif
