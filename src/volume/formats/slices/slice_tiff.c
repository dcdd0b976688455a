/* volume/formats/slices/slice_tiff.c - decodes TIFF slices through tiff_file.h. */
#include <string.h>

#include "core/error.h"
#include "core/memory.h"
#include "volume/formats/slices/slice_codecs.h"
#include "volume/formats/tiff/tiff_file.h"

static hl_status read(const hl_slice_file *file, tiff_file *tiff, hl_slice_shape *shape, int component,
                      void *voxels, hl_error *error) {
  tiff_shape page;
  hl_status status = tiff_file_shape(tiff, &page, error);
  if (status != HL_OK) return status;
  *shape = (hl_slice_shape){page.width, page.height, page.components,
                            page.type,  page.colors, page.premultiplied};
  const tiff_target target = {voxels, file->exact, file->first, 0, 0};
  if (voxels != NULL) return tiff_file_read(tiff, &page, component, &target, error);
  return tiff_file_can_hold(tiff, &page)
             ? HL_OK
             : hl_fail(error, HL_ERROR_INPUT,
                       "%s: the page promises %u x %u pixels, more than the file's %llu bytes can hold",
                       tiff->path, page.width, page.height, (unsigned long long)tiff->size);
}

hl_status hl_slice_read_tiff(const hl_slice_file *file, hl_slice_shape *shape, int component, void *voxels,
                             hl_error *error) {
  tiff_file tiff = {.descriptor = -1, .warnings = TIFF_NO_WARNINGS};
  hl_status status = tiff_file_open(file->context, file->path, file->bytes, file->length, true, &tiff, error);
  if (status == HL_OK) status = read(file, &tiff, shape, component, voxels, error);
  tiff_file_close(&tiff);
  return status;
}

hl_status hl_slice_find_stack(const hl_slice_file *file, hl_slice_stack *stack, hl_error *error) {
  tiff_file tiff = {.descriptor = -1, .warnings = TIFF_NO_WARNINGS};
  uint64_t *offsets = NULL;
  size_t count = 0;
  char *description = NULL;
  *stack = HL_SLICE_ALONE;
  if (file->length < 2 || (memcmp(file->bytes, "II", 2) != 0 && memcmp(file->bytes, "MM", 2) != 0))
    return HL_OK;
  hl_status status = tiff_file_open(file->context, file->path, file->bytes, file->length, true, &tiff, error);
  bool ome = status == HL_OK && TIFFGetField(tiff.tiff, TIFFTAG_IMAGEDESCRIPTION, &description) &&
             strstr(description, "<OME") != NULL;
  if (status == HL_OK && !ome) status = tiff_file_pages(&tiff, &offsets, &count, error);
  *stack = ome ? HL_SLICE_OF_OME : count > 1 ? HL_SLICE_STACK : HL_SLICE_ALONE;
  hl_release(file->context, offsets);
  tiff_file_close(&tiff);
  return status;
}
