/* volume/formats/dicom/jpeg_ls.c - decodes JPEG-LS frames by CharLS. */
#include "core/error.h"
#include "volume/formats/dicom/codecs.h"

#ifndef HL_HAS_JPEG_LS

hl_status hl_dicom_decode_jpeg_ls(const hl_dicom_packed *packed, void *values, hl_error *error) {
  (void)values;
  return hl_fail(
      error, HL_ERROR_UNSUPPORTED,
      "%s: its pixels are JPEG-LS, and this build has no CharLS: install libcharls-dev and build anew",
      packed->path);
}

#else

#include <charls/charls.h>
#include <string.h>

#include "core/memory.h"

/* Rearranges a picture whose components are stored as planes, so that the samples of each pixel lie side by
 * side. */
static hl_status interleave(const hl_dicom_packed *packed, size_t size, void *values, hl_error *error) {
  const hl_dicom_pixels *p = packed->pixels;
  size_t pixels = p->rows * p->columns, bytes = pixels * p->samples * size;
  unsigned char *planes = hl_allocate(packed->context, bytes, 1), *to = values;
  if (planes == NULL) return hl_fail_memory(error, bytes, packed->path);
  memcpy(planes, values, bytes);
  for (size_t n = 0; n < pixels; n++)
    for (size_t s = 0; s < p->samples; s++)
      memcpy(to + (n * p->samples + s) * size, planes + (s * pixels + n) * size, size);
  hl_release(packed->context, planes);
  return HL_OK;
}

static hl_status decode(charls_jpegls_decoder *decoder, const hl_dicom_packed *packed, void *values,
                        hl_error *error) {
  const hl_dicom_pixels *p = packed->pixels;
  size_t size = p->allocated > 8 ? 2 : 1, bytes = p->rows * p->columns * p->samples * size;
  charls_frame_info info;
  charls_interleave_mode mode;
  int fault = charls_jpegls_decoder_set_source_buffer(decoder, packed->bytes, packed->length);
  if (fault == 0) fault = charls_jpegls_decoder_read_header(decoder);
  if (fault == 0) fault = charls_jpegls_decoder_get_frame_info(decoder, &info);
  if (fault != 0)
    return hl_dicom_fail_packed(packed, "JPEG-LS", charls_get_error_message((charls_jpegls_errc)fault),
                                error);
  hl_status status = hl_dicom_check_packed(packed, "JPEG-LS", info.width, info.height,
                                           (size_t)info.component_count, info.bits_per_sample, error);
  if (status != HL_OK) return status;
  if ((info.bits_per_sample > 8) != (size == 2))
    return hl_dicom_fail_packed(packed, "JPEG-LS", "its samples have 8 bits where the file promises 16",
                                error);
  fault = charls_jpegls_decoder_get_interleave_mode(decoder, &mode);
  if (fault == 0) fault = charls_jpegls_decoder_decode_to_buffer(decoder, values, bytes, 0);
  if (fault != 0)
    return hl_dicom_fail_packed(packed, "JPEG-LS", charls_get_error_message((charls_jpegls_errc)fault),
                                error);
  bool planes = p->samples > 1 && mode == CHARLS_INTERLEAVE_MODE_NONE;
  return planes ? interleave(packed, size, values, error) : HL_OK;
}

hl_status hl_dicom_decode_jpeg_ls(const hl_dicom_packed *packed, void *values, hl_error *error) {
  charls_jpegls_decoder *decoder = charls_jpegls_decoder_create();
  if (decoder == NULL) return hl_fail_memory(error, 1000, "CharLS");
  hl_status status = decode(decoder, packed, values, error);
  charls_jpegls_decoder_destroy(decoder);
  return status;
}

#endif
