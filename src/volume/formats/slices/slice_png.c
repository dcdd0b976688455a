/* volume/formats/slices/slice_png.c - decodes PNG slices by libpng: grey and colours of 8 and 16 bits.
 * Samples of less than 8 bits are widened to 8 bits, and keep their values. Palettes become colours. */
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include "core/error.h"
#include "core/memory.h"
#include "volume/convert.h"
#include "volume/formats/slices/slice_codecs.h"

typedef struct png_slice {
  const hl_slice_file *file;
  hl_slice_shape *shape;
  unsigned char **samples; /* memory for the samples; null if only the shape is wanted */
  size_t at;
  png_structp png;
  png_infop info;
  png_bytep *rows; /* owned */
  hl_status status;
  hl_error *error;
} png_slice;

static void on_error(png_structp png, png_const_charp message) {
  png_slice *s = png_get_error_ptr(png);
  if (s->status == HL_OK)
    s->status = hl_fail(s->error, HL_ERROR_INPUT, "%s: a damaged PNG picture: %s", s->file->path, message);
  png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message) { (void)png, (void)message; }

static png_voidp on_allocate(png_structp png, png_alloc_size_t size) {
  png_slice *s = png_get_mem_ptr(png);
  void *memory = hl_allocate(s->file->context, size, 1);
  if (memory == NULL) s->status = hl_fail_memory(s->error, size, s->file->path);
  return memory;
}

static void on_release(png_structp png, png_voidp memory) {
  hl_release(((png_slice *)png_get_mem_ptr(png))->file->context, memory);
}

static void on_read(png_structp png, png_bytep to, size_t length) {
  png_slice *s = png_get_io_ptr(png);
  if (length > s->file->length - s->at) png_error(png, "the file ends too early");
  memcpy(to, s->file->bytes + s->at, length);
  s->at += length;
}

/* Ends decoding by a call of png_error(), which libpng itself calls on failures. Failures of libpng and of
 * this file are thus handled in the same way. */
static void stop(png_slice *s, hl_status status) {
  s->status = status;
  png_error(s->png, "stopped");
}

static void read_shape(png_slice *s) {
  const uint16_t one = 1;
  enum { DEFLATE_MOST = 1032 }; /* greatest number of bytes that one deflated byte can unpack to */
  png_set_user_limits(s->png, INT32_MAX, INT32_MAX);
  png_set_keep_unknown_chunks(s->png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
  png_read_info(s->png, s->info);
  int color = png_get_color_type(s->png, s->info), depth = png_get_bit_depth(s->png, s->info);
  bool palette = color == PNG_COLOR_TYPE_PALETTE;
  *s->shape = (hl_slice_shape){.width = png_get_image_width(s->png, s->info),
                               .height = png_get_image_height(s->png, s->info),
                               .samples = palette ? 3 : png_get_channels(s->png, s->info),
                               .type = depth == 16 ? HL_VOXEL_U16 : HL_VOXEL_U8};
  size_t most = 8 * (s->file->length > SIZE_MAX / 8 / 3 / DEFLATE_MOST ? SIZE_MAX / 8 / 3 / DEFLATE_MOST
                                                                       : s->file->length);
  hl_status status = hl_slice_check_size(s->file, s->shape, most * DEFLATE_MOST * (palette ? 3 : 1),
                                         s->error);
  if (status != HL_OK) stop(s, status);
  if (palette) png_set_palette_to_rgb(s->png);
  if (depth < 8) png_set_packing(s->png);
  if (depth == 16 && *(const unsigned char *)&one == 1) png_set_swap(s->png);
}

static void read_pixels(png_slice *s) {
  hl_context *context = s->file->context;
  size_t height = s->shape->height;
  size_t row = s->shape->width * s->shape->samples * hl_voxel_type_bytes(s->shape->type);
  png_set_interlace_handling(s->png);
  png_read_update_info(s->png, s->info);
  if (png_get_rowbytes(s->png, s->info) != row)
    stop(s, hl_fail(s->error, HL_ERROR_UNSUPPORTED,
                    "%s: a PNG picture of a palette with transparency: save it as RGBA", s->file->path));
  *s->samples = hl_allocate(context, row, height);
  s->rows = hl_allocate(context, height, sizeof *s->rows);
  if (*s->samples == NULL || s->rows == NULL) stop(s, hl_fail_memory(s->error, row * height, s->file->path));
  for (size_t y = 0; y < height; y++) s->rows[y] = *s->samples + y * row;
  png_read_image(s->png, s->rows);
}

static void read_png(png_slice *s) {
  if (setjmp(png_jmpbuf(s->png)) != 0) return;
  png_set_read_fn(s->png, s, on_read);
  read_shape(s);
  if (s->samples != NULL) read_pixels(s);
}

hl_status hl_slice_read_png(const hl_slice_file *file, hl_slice_shape *shape, unsigned char **samples,
                            hl_error *error) {
  png_slice s = {.file = file, .shape = shape, .samples = samples, .error = error};
  s.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &s, on_error, on_warning, &s, on_allocate,
                                   on_release);
  if (s.png != NULL) s.info = png_create_info_struct(s.png);
  if (s.info != NULL) read_png(&s);
  else s.status = hl_fail_memory(error, 1000, file->path);
  png_destroy_read_struct(&s.png, &s.info, NULL);
  hl_release(file->context, s.rows);
  return s.status;
}
