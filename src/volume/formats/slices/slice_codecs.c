/* volume/formats/slices/slice_codecs.c - functions that the decoders of slices share. */
#include "volume/formats/slices/slice_codecs.h"

#include "core/error.h"
#include "core/memory.h"
#include "volume/convert.h"

hl_status hl_slice_check_size(const hl_slice_file *file, const hl_slice_shape *shape, size_t bytes_most,
                              hl_error *error) {
  size_t bytes = shape->samples * hl_voxel_type_bytes(shape->type);
  if (shape->width > 0 && shape->height > 0 && hl_multiply(bytes, shape->width, &bytes) &&
      hl_multiply(bytes, shape->height, &bytes) && bytes <= bytes_most)
    return HL_OK;
  return hl_fail(error, HL_ERROR_INPUT,
                 "%s: the picture promises %zu x %zu pixels, more than the file's %zu bytes can hold",
                 file->path, shape->width, shape->height, file->length);
}
