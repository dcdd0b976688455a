/* volume/formats/dicom/codecs.h - decodes compressed frames.
 *
 * Each decoder fills [rows][columns][samples] values of 8 or 16 bits (the pixels' `allocated`), native byte
 * order; bits above the pixels' `stored` bits are undefined. A decoder whose library is absent fails and
 * names the library. */
#ifndef HL_VOLUME_DICOM_CODECS_H
#define HL_VOLUME_DICOM_CODECS_H

#include "volume/formats/dicom/header.h"

/* One compressed frame. */
typedef struct hl_dicom_packed {
  hl_context *context;
  const char *path; /* for error lines */
  const hl_dicom_pixels *pixels;
  const unsigned char *bytes;
  size_t length;
  bool *is_rgb; /* set to true if the decoder has converted the colours to RGB */
} hl_dicom_packed;

hl_status hl_dicom_decode_rle(const hl_dicom_packed *packed, void *values, hl_error *error);
hl_status hl_dicom_decode_jpeg(const hl_dicom_packed *packed, void *values, hl_error *error);
hl_status hl_dicom_decode_jpeg_extended(const hl_dicom_packed *packed, void *values, hl_error *error);
hl_status hl_dicom_decode_jpeg_lossless(const hl_dicom_packed *packed, void *values, hl_error *error);
hl_status hl_dicom_decode_jpeg_ls(const hl_dicom_packed *packed, void *values, hl_error *error);
hl_status hl_dicom_decode_jpeg_2000(const hl_dicom_packed *packed, void *values, hl_error *error);

/* Fails with "PATH: a damaged CODEC picture: WHY". */
hl_status hl_dicom_fail_packed(const hl_dicom_packed *packed, const char *codec, const char *why,
                               hl_error *error);
/* Fails unless the compressed data's own header promises the same pixels as the file's header. */
hl_status hl_dicom_check_packed(const hl_dicom_packed *packed, const char *codec, size_t columns, size_t rows,
                                size_t samples, int bits, hl_error *error);

#endif
