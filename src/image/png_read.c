/* png_read.c - PNG files of any kind to linear premultiplied floats, through libpng.
 *
 * In: the bytes of a file, which may be anything. Out: a picture. Grey, palette, 1 to 16 bits, transparency
 * and interlacing are all expanded to RGBA; samples are taken as sRGB whatever gAMA or iCCP say.
 *
 * Against hostile files: sizes are limited before allocation and held against the most that the file's bytes
 * can inflate to; every chunk but IHDR, PLTE, tRNS, IDAT and IEND is skipped unread.
 */
#include <png.h>
#include <setjmp.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "image/format.h"
#include "image/srgb.h"

/* No deflate stream gives more than this many bytes for each of its own (258 bytes from 2 bits). */
enum { INFLATE_RATIO_MAX = 1032 };

typedef struct png_reading {
  hl_context *context;
  const char *name;
  const unsigned char *bytes; /* borrowed; [length] */
  size_t length, at;
  hl_error *error;
  hl_status status;
  png_structp png;
  png_infop info;
  hl_image *image;
  float *linear; /* owned; [maximum + 1]; the sRGB curve, computed where first asked for; below 0: not yet */
  unsigned char *rows; /* owned; one row of RGBA samples, or all rows where the file is interlaced */
} png_reading;

static void on_error(png_structp png, png_const_charp message) {
  png_reading *reading = png_get_error_ptr(png);
  if (reading->status == HL_OK)
    reading->status = hl_fail_offset(reading->error, HL_ERROR_INPUT, (int64_t)reading->at,
                                     "%s: byte %zu: damaged PNG: %s", reading->name, reading->at, message);
  png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message) {
  (void)png;
  (void)message;
}

static png_voidp on_allocate(png_structp png, png_alloc_size_t size) {
  png_reading *reading = png_get_mem_ptr(png);
  void *memory = hl_allocate(reading->context, size, 1);
  if (memory == NULL) reading->status = hl_fail_memory(reading->error, size, reading->name);
  return memory;
}

static void on_release(png_structp png, png_voidp memory) {
  hl_release(((png_reading *)png_get_mem_ptr(png))->context, memory);
}

static void on_read(png_structp png, png_bytep to, size_t length) {
  png_reading *reading = png_get_io_ptr(png);
  if (length > reading->length - reading->at) png_error(png, "the file ends too early");
  memcpy(to, reading->bytes + reading->at, length);
  reading->at += length;
}

/* Fails by png_error, so that all failures leave by one way. */
static void stop(png_reading *reading, hl_status status) {
  reading->status = status;
  png_error(reading->png, "stopped");
}

static void read_header(png_reading *reading) {
  png_set_user_limits(reading->png, HL_IMAGE_SIDE_MAX, HL_IMAGE_SIDE_MAX);
  png_set_keep_unknown_chunks(reading->png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
  png_read_info(reading->png, reading->info);
  size_t height = png_get_image_height(reading->png, reading->info), claimed = 0;
  if (!hl_multiply(png_get_rowbytes(reading->png, reading->info), height, &claimed) ||
      claimed / INFLATE_RATIO_MAX > reading->length)
    stop(reading,
         hl_fail_offset(
             reading->error, HL_ERROR_INPUT, 16,
             "%s: byte 16: damaged PNG: claims %zu bytes of pixels, more than %zu bytes of file can hold",
             reading->name, claimed, reading->length));
  png_set_expand(reading->png);
  png_set_gray_to_rgb(reading->png);
  png_set_add_alpha(reading->png, 0xffff, PNG_FILLER_AFTER);
}

/* sample: big-endian, depth bits */
static const unsigned char *take_code(const unsigned char *from, int depth, int *code) {
  *code = depth == 16 ? from[0] << 8 | from[1] : from[0];
  return from + depth / 8;
}

static float decode_code(float *linear, int code, int maximum) {
  if (linear[code] < 0) linear[code] = (float)hl_srgb_decode((double)code / maximum);
  return linear[code];
}

static void convert_row(const png_reading *reading, const unsigned char *from, int depth, int y) {
  float *pixel = reading->image->pixels + (size_t)y * (size_t)reading->image->width * 4;
  const int maximum = depth == 16 ? 65535 : 255;
  for (int x = 0; x < reading->image->width; x++, pixel += 4) {
    int code[4];
    for (int c = 0; c < 4; c++) from = take_code(from, depth, &code[c]);
    pixel[3] = (float)code[3] / (float)maximum;
    for (int c = 0; c < 3; c++) pixel[c] = decode_code(reading->linear, code[c], maximum) * pixel[3];
  }
}

static void allocate_pixels(png_reading *reading, int depth, size_t row_bytes, bool interlaced) {
  size_t width = png_get_image_width(reading->png, reading->info);
  size_t height = png_get_image_height(reading->png, reading->info), rows = interlaced ? height : 1;
  hl_status status = hl_image_create_for_file(reading->context, reading->name, width, height, &reading->image,
                                              reading->error);
  if (status != HL_OK) stop(reading, status);
  size_t codes = depth == 16 ? 65536 : 256;
  reading->linear = hl_allocate(reading->context, codes, sizeof *reading->linear);
  reading->rows = hl_allocate(reading->context, rows, row_bytes);
  if (reading->linear == NULL || reading->rows == NULL)
    stop(reading, hl_fail_memory(reading->error, rows * row_bytes, reading->name));
  for (size_t i = 0; i < codes; i++) reading->linear[i] = -1;
}

/* All calls that may longjmp. reading outlives the jump and no local is read after it. */
static void read_png(png_reading *reading) {
  if (setjmp(png_jmpbuf(reading->png)) != 0) return;
  png_set_read_fn(reading->png, reading, on_read);
  read_header(reading);
  int passes = png_set_interlace_handling(reading->png);
  png_read_update_info(reading->png, reading->info);
  int depth = png_get_bit_depth(reading->png, reading->info);
  size_t row_bytes = png_get_rowbytes(reading->png, reading->info);
  allocate_pixels(reading, depth, row_bytes, passes > 1);
  for (int pass = 0; pass < passes; pass++)
    for (int y = 0; y < reading->image->height; y++) {
      unsigned char *row = reading->rows + (passes > 1 ? (size_t)y * row_bytes : 0);
      png_read_row(reading->png, row, NULL);
      if (hl_cancelled(reading->context))
        stop(reading, hl_fail(reading->error, HL_ERROR_CANCELLED, "%s: cancelled", reading->name));
      if (pass == passes - 1) convert_row(reading, row, depth, y);
    }
  png_read_end(reading->png, NULL);
}

static uint32_t take_32(const unsigned char *from) {
  return (uint32_t)from[0] << 24 | (uint32_t)from[1] << 16 | (uint32_t)from[2] << 8 | from[3];
}

/* From IHDR (PNG specification, section 11.2.2), which follows the mark: width, height, bit depth, colour
 * type. */
hl_image_claim hl_png_claim(const unsigned char *bytes, size_t length) {
  static const unsigned char channels[7] = {1, 0, 3, 1, 2, 0, 4}; /* of each colour type */
  enum { IHDR = 12, WIDTH = 16, HEIGHT = 20, DEPTH = 24, TYPE = 25 };
  hl_image_claim claim = {0};
  if (length <= TYPE || memcmp(bytes + IHDR, "IHDR", 4) != 0 || bytes[TYPE] > 6 || bytes[DEPTH] > 16)
    return claim;
  claim = (hl_image_claim){true, take_32(bytes + WIDTH), take_32(bytes + HEIGHT), 0};
  if (claim.width <= HL_IMAGE_SIDE_MAX && claim.height <= HL_IMAGE_SIDE_MAX)
    claim.bytes = (1 + (claim.width * channels[bytes[TYPE]] * bytes[DEPTH] + 7) / 8) * claim.height;
  return claim;
}

hl_status hl_png_decode(hl_context *context, const char *name, const unsigned char *bytes, size_t length,
                        hl_image **image, hl_error *error) {
  png_reading reading = {.context = context, .name = name, .bytes = bytes, .length = length, .error = error};
  reading.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &reading, on_error, on_warning, &reading,
                                         on_allocate, on_release);
  reading.info = reading.png == NULL ? NULL : png_create_info_struct(reading.png);
  if (reading.info == NULL) reading.status = hl_fail_memory(error, sizeof reading, name);
  else read_png(&reading);
  png_destroy_read_struct(&reading.png, &reading.info, NULL);
  hl_release(context, reading.rows);
  hl_release(context, reading.linear);
  if (reading.status != HL_OK) hl_image_destroy(reading.image);
  else *image = reading.image;
  return reading.status;
}
