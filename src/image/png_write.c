/* png_write.c - pictures as PNG, 8 or 16 bits, through libpng.
 *
 * In: linear premultiplied floats, a linear background. Out: sRGB codes, RGB over the background or, with
 * background_transparent, unassociated RGBA; the scene as a compressed text chunk.
 *
 * Exposure, compositing and alpha division are done in linear light; the curve is applied last (srgb.h).
 *
 * Eight bits are too few for smooth dark gradients such as penumbras: rounding draws contours, 10 pixels wide
 * and more, that the eye finds. Measured on a penumbra-like gradient of 0.004 to 0.034 linear over 256 x 256
 * pixels, after averaging 8 x 8 pixels as the eye does at a distance: rounding errs by 0.070 codes (root mean
 * square; 0.34 at worst), with an 8 x 8 ordered dither 0.020 (0.08), and the contours are gone when the
 * contrast is raised; white noise (0.050) and two low-discrepancy patterns (0.019 and 0.029) were no better
 * to look at, and the ordered one keeps files smallest. So 8-bit codes are dithered by less than half a code,
 * by position alone, the same in all channels (greys stay grey). Values that are whole codes stay as they
 * are, so a PNG that is read and written again keeps its bytes, and pixels without any volume are rounded: a
 * flat background stays flat. 16 bits are rounded.
 */
#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <string.h>

#include "core/memory.h"
#include "image/format.h"
#include "image/srgb.h"

typedef struct png_writing {
  const hl_image *image;
  const hl_image_write_options *options;
  hl_output *output;
  hl_error *error;
  hl_status status;
  float background[3]; /* linear */
  float exposure;      /* what the picture's light is multiplied by */
  hl_srgb_encoder encoder;
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

/* The 8 x 8 ordered (Bayer) pattern: the bits of x ^ y and y, interlaced and mirrored, count each of 0..63
 * once. Offsets in codes, -63/128 .. 63/128. */
static float dither_offset(int x, int y) {
  int order = 0;
  for (int bit = 0; bit < 3; bit++)
    order |= (((x ^ y) >> bit & 1) << (5 - 2 * bit)) | ((y >> bit & 1) << (4 - 2 * bit));
  return (float)(2 * order - 63) / 128.0f;
}

/* Alpha is linear: nearest code of [0, 1], NaN gives 0. */
static int quantise(float value, int maximum, float offset) {
  if (!(value > 0)) return 0;
  if (value >= 1) return maximum;
  return (int)((float)maximum * value + offset + 0.5f);
}

static unsigned char *put_code(unsigned char *to, int code, int depth) {
  if (depth == 16) *to++ = (unsigned char)(code >> 8);
  *to++ = (unsigned char)(code & 0xff);
  return to;
}

static bool is_empty(const float pixel[4]) {
  return pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 0 && pixel[3] == 0;
}

/* The linear value that colour c of a pixel is stored as. */
static float stored_value(const png_writing *writing, const float pixel[4], int c) {
  if (!writing->options->background_transparent) return pixel[c] * writing->exposure + (1 - pixel[3]) * writing->background[c];
  /* Light above alpha (emission) cannot be told in unassociated colour: it saturates. */
  return pixel[3] > 0 ? pixel[c] / pixel[3] * writing->exposure : 0;
}

static void encode_row(png_writing *writing, int y) {
  const int depth = writing->options->png_depth, transparent = writing->options->background_transparent;
  const float *pixel = writing->image->pixels + (size_t)y * (size_t)writing->image->width * 4;
  unsigned char *to = writing->row;
  for (int x = 0; x < writing->image->width; x++, pixel += 4) {
    float offset = depth == 16 || is_empty(pixel) ? 0.0f : dither_offset(x, y);
    for (int c = 0; c < 3; c++)
      to = put_code(to, hl_srgb_encode_offset(&writing->encoder, stored_value(writing, pixel, c), offset),
                    depth);
    if (transparent) to = put_code(to, quantise(pixel[3], writing->encoder.maximum, offset), depth);
  }
}

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
    encode_row(writing, y);
    png_write_row(writing->png, writing->row);
  }
  png_write_end(writing->png, NULL);
}

hl_status hl_png_encode(const hl_image *image, const hl_image_write_options *options, hl_output *output,
                        hl_error *error) {
  png_writing writing = {.image = image, .options = options, .output = output, .error = error};
  for (int c = 0; c < 3; c++) writing.background[c] = (float)options->background[c];
  writing.exposure = (float)hl_exposure_factor(options->exposure);
  hl_status status = hl_srgb_encoder_create(output->context, options->png_depth == 16 ? 65535 : 255,
                                            &writing.encoder, error);
  if (status != HL_OK) return status;
  size_t row_bytes = (size_t)image->width * 4 * (size_t)(options->png_depth / 8);
  writing.row = hl_allocate(output->context, row_bytes, 1);
  writing.png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &writing, on_error, on_warning, &writing,
                                          on_allocate, on_release);
  writing.info = writing.png == NULL ? NULL : png_create_info_struct(writing.png);
  if (writing.row == NULL || writing.info == NULL)
    writing.status = hl_fail_memory(error, row_bytes, output->path);
  else
    write_png(&writing);
  png_destroy_write_struct(&writing.png, &writing.info);
  hl_release(output->context, writing.row);
  hl_srgb_encoder_destroy(&writing.encoder);
  return writing.status;
}
