/* volume/formats/slices/slice_jpeg.c - decodes JPEG slices of 8 bits, grey or in colours, by libjpeg. */
#include "core/error.h"
#include "volume/formats/slices/slice_codecs.h"

#ifndef HL_HAS_JPEG

hl_status hl_slice_read_jpeg(const hl_slice_file *file, hl_slice_shape *shape, unsigned char **samples,
                             hl_error *error) {
  (void)shape, (void)samples;
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "%s: a JPEG picture, and this build has no libjpeg: install libjpeg-dev and build anew",
                 file->path);
}

#else

#include "core/memory.h"
#include "volume/io/jpeg_fault.h"

/* Decodes a slice by libjpeg. An error of libjpeg leaves this function by longjmp. The caller must destroy
 * the decoder also after an error. */
static hl_status run(struct jpeg_decompress_struct *info, const hl_slice_file *file, hl_slice_shape *shape,
                     unsigned char **samples, hl_error *error) {
  enum { PIXELS_OF_BYTE = 8 * 64 }; /* each block of 8 x 8 pixels takes at least one bit */
  jpeg_mem_src(info, file->bytes, file->length);
  jpeg_read_header(info, TRUE);
  bool grey = info->num_components == 1;
  if (info->num_components != 3 && !grey)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: a JPEG picture of %d components: 1 and 3 are read: save it as grey or RGB",
                   file->path, info->num_components);
  info->out_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
  *shape = (hl_slice_shape){
      .width = info->image_width, .height = info->image_height, .samples = grey ? 1 : 3, .type = HL_VOXEL_U8};
  size_t most = file->length < SIZE_MAX / PIXELS_OF_BYTE / 4 ? file->length * PIXELS_OF_BYTE * 4 : SIZE_MAX;
  hl_status status = hl_slice_check_size(file, shape, most, error);
  if (status != HL_OK || samples == NULL) return status;
  size_t row_bytes = shape->width * shape->samples;
  *samples = hl_allocate(file->context, row_bytes, shape->height);
  if (*samples == NULL) return hl_fail_memory(error, row_bytes * shape->height, file->path);
  jpeg_start_decompress(info);
  while (info->output_scanline < info->output_height) {
    JSAMPROW row = *samples + (size_t)info->output_scanline * row_bytes;
    jpeg_read_scanlines(info, &row, 1);
  }
  jpeg_finish_decompress(info);
  return HL_OK;
}

hl_status hl_slice_read_jpeg(const hl_slice_file *file, hl_slice_shape *shape, unsigned char **samples,
                             hl_error *error) {
  struct jpeg_decompress_struct info = {0};
  hl_jpeg_fault fault = {.message = ""};
  volatile hl_status status = HL_OK;
  hl_jpeg_catch(&info, &fault);
  if (setjmp(fault.jump) == 0) {
    jpeg_create_decompress(&info);
    status = run(&info, file, shape, samples, error);
  } else {
    status = hl_fail(error, HL_ERROR_INPUT, "%s: a damaged JPEG picture: %s", file->path, fault.message);
  }
  jpeg_destroy_decompress(&info);
  return status;
}

#endif
