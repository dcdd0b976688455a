/* volume/formats/dicom/jpeg.c - decodes JPEG frames. jpeg_lossless.c decodes the lossless process.
 * jpeg_extended.c decodes samples of 12 bits, and libjpeg decodes samples of 8 bits. */
#include "core/error.h"
#include "volume/formats/dicom/codecs.h"

/* Finds the process of a JPEG picture: the number n, 0 to 15, of its frame header's marker SOFn (T.81,
 * B.2.2). *bits: set to the precision in bits; 0 if the picture has no frame header. */
static int find_process(const hl_dicom_packed *packed, int *bits) {
  const unsigned char *bytes = packed->bytes;
  for (size_t n = 2; n + 5 < packed->length;) {
    if (bytes[n] != 0xff) return 0;
    int marker = bytes[n + 1];
    if (marker == 0xff) {
      n++;
      continue;
    }
    *bits = bytes[n + 4];
    if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc) return marker;
    n += 2 + ((size_t)bytes[n + 2] << 8 | bytes[n + 3]);
  }
  return 0;
}

#ifndef HL_HAS_JPEG

static hl_status decode(const hl_dicom_packed *packed, void *values, hl_error *error) {
  (void)values;
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "%s: its pixels are JPEG, and this build has no libjpeg: install libjpeg-dev and build anew",
                 packed->path);
}

#else

#include <string.h>

#include "volume/io/jpeg_fault.h"

/* Decodes a frame by libjpeg. An error of libjpeg leaves this function by longjmp. The caller must destroy
 * the decoder also after an error. */
static hl_status run(struct jpeg_decompress_struct *info, const hl_dicom_packed *packed,
                     unsigned char *values, hl_error *error) {
  const hl_dicom_pixels *p = packed->pixels;
  jpeg_mem_src(info, packed->bytes, packed->length);
  jpeg_read_header(info, TRUE);
  hl_status status = hl_dicom_check_packed(packed, "JPEG", info->image_width, info->image_height,
                                           (size_t)info->num_components, info->data_precision, error);
  if (status != HL_OK) return status;
  /* without a marker of Adobe or JFIF in the JPEG data, the DICOM file decides whether the picture is RGB */
  bool told = info->saw_Adobe_marker || info->saw_JFIF_marker;
  if (info->num_components == 3 && !told) info->jpeg_color_space = p->is_ybr ? JCS_YCbCr : JCS_RGB;
  info->out_color_space = info->num_components == 3 ? JCS_RGB : JCS_GRAYSCALE;
  jpeg_start_decompress(info);
  while (info->output_scanline < info->output_height) {
    JSAMPROW row = values + (size_t)info->output_scanline * p->columns * p->samples;
    jpeg_read_scanlines(info, &row, 1);
  }
  jpeg_finish_decompress(info);
  return HL_OK;
}

static hl_status decode(const hl_dicom_packed *packed, void *values, hl_error *error) {
  struct jpeg_decompress_struct info = {0};
  hl_jpeg_fault fault = {.message = ""};
  volatile hl_status status = HL_OK;
  hl_jpeg_catch(&info, &fault);
  if (setjmp(fault.jump) == 0) {
    jpeg_create_decompress(&info);
    status = run(&info, packed, values, error);
  } else {
    status = hl_dicom_fail_packed(packed, "JPEG", fault.message, error);
  }
  jpeg_destroy_decompress(&info);
  return status;
}

#endif

/* Converts samples of 8 bits to 16 bits, in place, from the last sample to the first. */
static void widen(const hl_dicom_pixels *p, void *values) {
  for (size_t n = p->rows * p->columns * p->samples; n > 0; n--)
    ((uint16_t *)values)[n - 1] = ((const unsigned char *)values)[n - 1];
}

hl_status hl_dicom_decode_jpeg(const hl_dicom_packed *packed, void *values, hl_error *error) {
  int bits = 0, process = find_process(packed, &bits);
  if (process == 0xc3) return hl_dicom_decode_jpeg_lossless(packed, values, error);
  if (process == 0) return hl_dicom_fail_packed(packed, "JPEG", "it has no frame header", error);
  if (bits != 8) return hl_dicom_decode_jpeg_extended(packed, values, error);
  hl_status status = decode(packed, values, error);
  if (status == HL_OK && packed->pixels->allocated > 8) widen(packed->pixels, values);
  *packed->is_rgb = true;
  return status;
}
