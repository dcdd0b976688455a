/* png_write.c - pictures as PNG, 8 or 16 bits, through libpng.
 *
 * In: linear premultiplied floats, a linear background. Out: sRGB codes, RGB over the background or, with
 * background_transparent, unassociated RGBA (codes.c); the scene as a compressed text chunk.
 */
#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <string.h>

#include "core/memory.h"
#include "image/codes.h"
#include "image/format.h"

typedef struct png_writing {
  const hl_image *image;
  const hl_image_write_options *options;
  hl_output *output;
  hl_error *error;
  hl_status status;
  hl_codes codes;
  png_structp png;
  png_infop info;
  unsigned char *row; /* owned; [width][channels], big-endian samples of png_depth bits */
} png_writing;

static void on_error(png_structp png, png_const_charp message) {
  png_writing *writing = png_get_error_ptr(png);
  if (writing->status == HL_OK)
    writing->status = hl_fail(writing->error, HL_ERROR_INTERNAL, "%s: cannot write: libpng says: %s",
                              writing->output->path, message);
  png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message) {
  (void)png;
  (void)message;
}

static png_voidp on_allocate(png_structp png, png_alloc_size_t size) {
  png_writing *writing = png_get_mem_ptr(png);
  void *memory = hl_allocate(writing->output->context, size, 1);
  if (memory == NULL) writing->status = hl_fail_memory(writing->error, size, writing->output->path);
  return memory;
}

static void on_release(png_structp png, png_voidp memory) {
  png_writing *writing = png_get_mem_ptr(png);
  hl_release(writing->output->context, memory);
}

static void on_write(png_structp png, png_bytep bytes, size_t length) {
  png_writing *writing = png_get_io_ptr(png);
  errno = 0;
  if (fwrite(bytes, 1, length, writing->output->file) == length) return;
  writing->status = hl_fail_write(writing->error, writing->output, errno);
  png_error(png, "write failed");
}

static void on_flush(png_structp png) { (void)png; }

static void write_scene(png_writing *writing) {
  png_text text;
  memset(&text, 0, sizeof text);
  text.compression = PNG_ITXT_COMPRESSION_zTXt;
  text.key = (png_charp) "halflight:scene";
  text.text = (png_charp)writing->options->scene_json;
  text.itxt_length = strlen(writing->options->scene_json);
  text.lang = (png_charp) "";
  text.lang_key = (png_charp) "";
  png_set_text(writing->png, writing->info, &text, 1);
}

/* All calls that may longjmp. writing outlives the jump and no local is read after it. */
static void write_png(png_writing *writing) {
  const hl_image *image = writing->image;
  if (setjmp(png_jmpbuf(writing->png)) != 0) return;
  png_set_write_fn(writing->png, writing, on_write, on_flush);
  png_set_IHDR(writing->png, writing->info, (png_uint_32)image->width, (png_uint_32)image->height,
               writing->options->png_depth,
               writing->options->background_transparent ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(writing->png, writing->info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (writing->options->scene_json != NULL) write_scene(writing);
  png_write_info(writing->png, writing->info);
  for (int y = 0; y < image->height; y++) {
    writing->status = hl_encode_step(writing->output->context, y, image->height, writing->error);
    if (writing->status != HL_OK) return;
    hl_codes_of_row(&writing->codes, image->pixels + (size_t)y * (size_t)image->width * 4, image->width, y,
                    writing->row);
    png_write_row(writing->png, writing->row);
  }
  png_write_end(writing->png, NULL);
}

hl_status hl_png_encode(const hl_image *image, const hl_image_write_options *options, hl_output *output,
                        hl_error *error) {
  png_writing writing = {.image = image, .options = options, .output = output, .error = error};
  hl_status status = hl_codes_begin(output->context, options, options->png_depth, &writing.codes, error);
  if (status != HL_OK) return status;
  size_t row_bytes = (size_t)image->width * 4 * (size_t)(options->png_depth / 8);
  writing.row = hl_allocate(output->context, row_bytes, 1);
  writing.png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &writing, on_error, on_warning, &writing,
                                          on_allocate, on_release);
  writing.info = writing.png == NULL ? NULL : png_create_info_struct(writing.png);
  if (writing.row == NULL || writing.info == NULL)
    writing.status = hl_fail_memory(error, row_bytes, output->path);
  else write_png(&writing);
  png_destroy_write_struct(&writing.png, &writing.info);
  hl_release(output->context, writing.row);
  hl_codes_end(&writing.codes);
  return writing.status;
}
