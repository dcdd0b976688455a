/* volume/formats/dicom/codecs.c - functions that the decoders of compressed frames share. One function
 * compares a frame's own header with the file's header. A second function reports damaged frames. */
#include "volume/formats/dicom/codecs.h"

hl_status hl_dicom_fail_packed(const hl_dicom_packed *packed, const char *codec, const char *why,
                               hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: a damaged %s picture: %s", packed->path, codec, why);
}

hl_status hl_dicom_check_packed(const hl_dicom_packed *packed, const char *codec, size_t columns, size_t rows,
                                size_t samples, int bits, hl_error *error) {
  const hl_dicom_pixels *p = packed->pixels;
  if (columns == p->columns && rows == p->rows && samples == p->samples && bits >= 1 && bits <= p->allocated)
    return HL_OK;
  return hl_fail(error, HL_ERROR_INPUT,
                 "%s: its %s picture is %zu x %zu pixels of %zu samples of %d bits, the file promises "
                 "%zu x %zu of %zu of %d",
                 packed->path, codec, columns, rows, samples, bits, p->columns, p->rows, p->samples,
                 p->allocated);
}
