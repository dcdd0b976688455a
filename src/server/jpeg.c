/* server/jpeg.c - encodes pictures as JPEG, for frames that are seen only for a moment. */
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>

#include <jpeglib.h>

#include "parts.h"

/* The error handler that replaces libjpeg's own, which would end the program. */
typedef struct failing {
  struct jpeg_error_mgr manager;
  jmp_buf back;
} failing;

static void on_error(j_common_ptr codec) { longjmp(((failing *)codec->err)->back, 1); }

static void on_message(j_common_ptr codec) { (void)codec; }

unsigned char *encode_jpeg(const uint8_t *rgba, int width, int height, int quality, size_t *length) {
  struct jpeg_compress_struct codec;
  failing errors;
  unsigned char *volatile result = NULL;
  unsigned char *bytes = NULL;
  unsigned long size = 0;
  codec.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = on_error;
  errors.manager.output_message = on_message;
  if (setjmp(errors.back) == 0) {
    jpeg_create_compress(&codec);
    jpeg_mem_dest(&codec, &bytes, &size);
    codec.image_width = (JDIMENSION)width;
    codec.image_height = (JDIMENSION)height;
    codec.input_components = 4;
    codec.in_color_space = JCS_EXT_RGBX;
    jpeg_set_defaults(&codec);
    jpeg_set_quality(&codec, quality, TRUE);
    codec.dct_method = JDCT_IFAST;
    jpeg_start_compress(&codec, TRUE);
    while (codec.next_scanline < codec.image_height) {
      JSAMPROW row = (JSAMPROW)(rgba + 4 * (size_t)width * codec.next_scanline);
      jpeg_write_scanlines(&codec, &row, 1);
    }
    jpeg_finish_compress(&codec);
    result = bytes;
  }
  jpeg_destroy_compress(&codec);
  *length = size;
  return result;
}
