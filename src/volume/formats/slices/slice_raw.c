/* volume/formats/slices/slice_raw.c - reads slices of bare voxels. The name of a slice, or of one of its
 * folders, states the size and the type of the voxels: scan_512x512_uint16/0001.raw,
 * slice_0001_512x512_uint16_be.raw. */
#include <string.h>

#include "volume/convert.h"
#include "volume/formats/raw.h"
#include "volume/formats/slices/slice_codecs.h"
#include "volume/io/text.h"

bool hl_slice_is_raw(const char *name) {
  return hl_text_ends(name, ".raw") || hl_text_ends(name, ".bin") || hl_text_ends(name, ".img");
}

/* Searches for size and type in the name of the file, and then in the names of its folders, from the
 * innermost on. */
static bool find_name(const char *path, hl_raw_slice *slice) {
  for (const char *end = path + strlen(path), *begin; end > path; end = begin - (begin > path)) {
    begin = end;
    while (begin > path && begin[-1] != '/') begin--;
    if (hl_raw_slice_name(begin, (size_t)(end - begin), slice)) return true;
  }
  return false;
}

hl_status hl_slice_read_raw(const hl_slice_file *file, hl_slice_shape *shape, void *voxels, hl_error *error) {
  hl_raw_slice slice;
  const uint16_t one = 1;
  size_t count, bytes;
  if (!find_name(file->path, &slice))
    return hl_fail(
        error, HL_ERROR_INPUT,
        "%s: raw slices need their size and type in their names or in their folder's, as in "
        "name_512x512_uint16/0001.raw (_be after the type for big-endian), or an .nhdr header that "
        "lists them",
        file->path);
  if (__builtin_mul_overflow(slice.width, slice.height, &count) ||
      __builtin_mul_overflow(count, hl_voxel_type_bytes(slice.type), &bytes) || bytes != file->length)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: its name promises %zu x %zu voxels of %s, the file has %zu bytes", file->path,
                   slice.width, slice.height, hl_voxel_type_name(slice.type), file->length);
  *shape = (hl_slice_shape){slice.width, slice.height, 1, slice.type, false, false};
  if (voxels == NULL) return HL_OK;
  bool swap = slice.big_endian == (*(const unsigned char *)&one == 1);
  hl_exact_note(file->exact, swap, file->bytes, file->first, count);
  hl_voxels_store(slice.type, swap, file->bytes, count, voxels);
  return HL_OK;
}
