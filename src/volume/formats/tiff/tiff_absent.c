/* volume/formats/tiff/tiff_absent.c - refuses TIFF files, in builds without libtiff. */
#include "volume/formats/slices/slice_codecs.h"
#include "volume/formats/tiff/tiff.h"

hl_status hl_tiff_load(hl_stream **stream, const hl_bundle *archive, hl_load_request *request,
                       hl_volume **volume, hl_error *error) {
  (void)archive, (void)request, (void)volume;
  return hl_fail(
      error, HL_ERROR_UNSUPPORTED,
      "%s: a TIFF file, and this program was built without libtiff: install libtiff-dev and build anew",
      (*stream)->path);
}

hl_status hl_slice_read_tiff(const hl_slice_file *file, hl_slice_shape *shape, int component, void *voxels,
                             hl_error *error) {
  (void)shape, (void)component, (void)voxels;
  return hl_fail(
      error, HL_ERROR_UNSUPPORTED,
      "%s: a TIFF file, and this program was built without libtiff: install libtiff-dev and build anew",
      file->path);
}

hl_status hl_slice_find_stack(const hl_slice_file *file, hl_slice_stack *stack, hl_error *error) {
  (void)file, (void)error;
  *stack = HL_SLICE_ALONE;
  return HL_OK;
}

const char *hl_tiff_missing(void) { return "libtiff"; }
