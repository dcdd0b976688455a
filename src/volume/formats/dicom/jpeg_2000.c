/* volume/formats/dicom/jpeg_2000.c - decodes JPEG 2000 and HTJ2K frames by OpenJPEG, which reads HTJ2K since
 * its version 2.5. */
#include "core/error.h"
#include "volume/formats/dicom/codecs.h"

#ifndef HL_HAS_JPEG_2000

hl_status hl_dicom_decode_jpeg_2000(const hl_dicom_packed *packed, void *values, hl_error *error) {
  (void)values;
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "%s: its pixels are JPEG 2000, and this build has no OpenJPEG: install libopenjp2-7-dev and "
                 "build anew",
                 packed->path);
}

#else

#include <openjpeg.h>
#include <string.h>

/* The bytes of a frame, which OpenJPEG reads as a stream. */
typedef struct pulled {
  const unsigned char *bytes;
  size_t length, at;
} pulled;

static OPJ_SIZE_T pull(void *buffer, OPJ_SIZE_T wanted, void *data) {
  pulled *p = data;
  size_t left = p->length - p->at, count = wanted < left ? wanted : left;
  if (count == 0) return (OPJ_SIZE_T)-1;
  memcpy(buffer, p->bytes + p->at, count);
  p->at += count;
  return count;
}

static OPJ_OFF_T skip(OPJ_OFF_T count, void *data) {
  pulled *p = data;
  size_t left = p->length - p->at;
  if (count < 0) return -1;
  p->at += (size_t)count < left ? (size_t)count : left;
  return count;
}

static OPJ_BOOL seek(OPJ_OFF_T at, void *data) {
  pulled *p = data;
  if (at < 0 || (size_t)at > p->length) return OPJ_FALSE;
  p->at = (size_t)at;
  return OPJ_TRUE;
}

static void pass_over(const char *message, void *data) { (void)message, (void)data; }

static void store(const opj_image_t *image, const hl_dicom_pixels *p, void *values) {
  size_t pixels = p->rows * p->columns;
  for (size_t s = 0; s < p->samples; s++) {
    const OPJ_INT32 *from = image->comps[s].data;
    for (size_t n = 0; n < pixels; n++)
      if (p->allocated > 8) ((uint16_t *)values)[n * p->samples + s] = (uint16_t)from[n];
      else ((unsigned char *)values)[n * p->samples + s] = (unsigned char)from[n];
  }
}

static hl_status check(const hl_dicom_packed *packed, const opj_image_t *image, hl_error *error) {
  for (OPJ_UINT32 c = 0; c < image->numcomps; c++) {
    const opj_image_comp_t *comp = &image->comps[c];
    hl_status status = hl_dicom_check_packed(packed, "JPEG 2000", comp->w, comp->h, image->numcomps,
                                             (int)comp->prec, error);
    if (status != HL_OK) return status;
  }
  return hl_dicom_check_packed(packed, "JPEG 2000", image->x1 - image->x0, image->y1 - image->y0,
                               image->numcomps, 8, error);
}

static hl_status decode(opj_codec_t *codec, opj_stream_t *stream, const hl_dicom_packed *packed, void *values,
                        hl_error *error) {
  opj_dparameters_t parameters;
  opj_image_t *image = NULL;
  opj_set_default_decoder_parameters(&parameters);
  opj_set_info_handler(codec, pass_over, NULL);
  opj_set_warning_handler(codec, pass_over, NULL);
  opj_set_error_handler(codec, pass_over, NULL);
  hl_status status = HL_OK;
  if (!opj_setup_decoder(codec, &parameters) || !opj_read_header(stream, codec, &image))
    status = hl_dicom_fail_packed(packed, "JPEG 2000", "its header cannot be read", error);
  if (status == HL_OK) status = check(packed, image, error);
  if (status == HL_OK && !opj_decode(codec, stream, image))
    status = hl_dicom_fail_packed(packed, "JPEG 2000", "it cannot be decoded", error);
  if (status == HL_OK) status = check(packed, image, error);
  for (OPJ_UINT32 c = 0; status == HL_OK && c < image->numcomps; c++)
    if (image->comps[c].data == NULL)
      status = hl_dicom_fail_packed(packed, "JPEG 2000", "a component is missing", error);
  if (status == HL_OK) store(image, packed->pixels, values);
  if (image != NULL) opj_image_destroy(image);
  return status;
}

/* Decodes a frame. A frame should be a bare codestream, but some writers put the codestream into a JP2
 * file. */
hl_status hl_dicom_decode_jpeg_2000(const hl_dicom_packed *packed, void *values, hl_error *error) {
  pulled source = {packed->bytes, packed->length, 0};
  bool is_file = packed->length > 12 && memcmp(packed->bytes + 4, "jP  \r\n\x87\n", 8) == 0;
  opj_codec_t *codec = opj_create_decompress(is_file ? OPJ_CODEC_JP2 : OPJ_CODEC_J2K);
  opj_stream_t *stream = opj_stream_create(1 << 16, OPJ_TRUE);
  hl_status status = HL_OK;
  if (codec == NULL || stream == NULL) {
    status = hl_fail_memory(error, 1 << 16, "OpenJPEG");
  } else {
    opj_stream_set_user_data(stream, &source, NULL);
    opj_stream_set_user_data_length(stream, packed->length);
    opj_stream_set_read_function(stream, pull);
    opj_stream_set_skip_function(stream, skip);
    opj_stream_set_seek_function(stream, seek);
    status = decode(codec, stream, packed, values, error);
  }
  if (stream != NULL) opj_stream_destroy(stream);
  if (codec != NULL) opj_destroy_codec(codec);
  *packed->is_rgb = true; /* the library has undone the colour transform of JPEG 2000 */
  return status;
}

#endif
