/* image/png.c - reads PNG files of any kind, and writes PNG files of 8 or 16 bits, by libpng; finds the scene
 * that is stored in a picture.
 *
 * In: the bytes of a file, which may be anything. Out: a picture. Grey, palette, 1 to 16 bits, transparency
 * and interlacing are all expanded to RGBA; samples are interpreted as sRGB, and the chunks gAMA and iCCP are
 * ignored.
 *
 * Out to a file: sRGB codes, RGB over the background or, with background_transparent, unassociated RGBA
 * (codes.c); the scene as a compressed text chunk.
 *
 * Against hostile files: sizes are limited before allocation and compared with the greatest size that the
 * file's bytes can inflate to. While the picture is decoded, every chunk but IHDR, PLTE, tRNS, IDAT and IEND
 * is skipped without being read. Another pass over the chunks finds the scene's text. */
#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <string.h>
#include <zlib.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "image/codes.h"
#include "image/format.h"
#include "image/srgb.h"

enum { MARK_BYTES = 8 };

/* The keyword of the text chunk that holds the scene. */
static const char keyword[] = "halflight:scene";
/* The keyword of the text chunk that says how much the fields of the scene's volumes differ from their
 * files. */
static const char field_errors_keyword[] = "halflight:field_errors";

static uint32_t load_32(const unsigned char *bytes) {
  return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* ---- reading ---- */

/* The greatest number of bytes to which one byte of a deflate stream can expand (2 bits can stand for 258
 * bytes). */
enum { INFLATE_RATIO_MAX = 1032 };

typedef struct png_reading {
  hl_context *context;
  const char *name;
  const unsigned char *bytes; /* borrowed; [length]; the bytes of the file */
  size_t length, at;
  hl_error *error;
  hl_status status;
  png_structp png;
  png_infop info;
  hl_image *image;
  float *linear; /* owned; [maximum + 1]; the linear value of each code, which is computed when it is first
                  * needed; negative until then */
  unsigned char *rows; /* owned; one row of RGBA samples, or all rows if the file is interlaced */
} png_reading;

static void on_read_error(png_structp png, png_const_charp message) {
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

static png_voidp on_read_allocate(png_structp png, png_alloc_size_t size) {
  png_reading *reading = png_get_mem_ptr(png);
  void *memory = hl_allocate(reading->context, size, 1);
  if (memory == NULL) reading->status = hl_fail_memory(reading->error, size, reading->name);
  return memory;
}

static void on_read_release(png_structp png, png_voidp memory) {
  hl_release(((png_reading *)png_get_mem_ptr(png))->context, memory);
}

static void on_read(png_structp png, png_bytep to, size_t length) {
  png_reading *reading = png_get_io_ptr(png);
  if (length > reading->length - reading->at) png_error(png, "the file ends too early");
  memcpy(to, reading->bytes + reading->at, length);
  reading->at += length;
}

/* Fails by png_error(), like libpng itself, so that the same code handles all failures. */
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

/* Reads the code of one sample. from: the sample of `depth` bits, whose more significant byte comes first.
 * Returns the position after the sample. */
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

/* Contains all calls of libpng's reader that may longjmp. The struct `reading` stays valid after the jump,
 * and no local variable is used after it. */
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

/* Reads the size from IHDR (PNG specification, section 11.2.2), which follows the mark. IHDR has width,
 * height, bit depth and colour type. */
static hl_image_claim claim(const unsigned char *bytes, size_t length) {
  /* the number of channels of each colour type of PNG */
  static const unsigned char channels[7] = {1, 0, 3, 1, 2, 0, 4};
  enum { IHDR = 12, WIDTH = 16, HEIGHT = 20, DEPTH = 24, TYPE = 25 };
  hl_image_claim claimed = {0};
  if (length <= TYPE || memcmp(bytes + IHDR, "IHDR", 4) != 0 || bytes[TYPE] > 6 || bytes[DEPTH] > 16)
    return claimed;
  const bool palette = bytes[TYPE] == 3;
  claimed = (hl_image_claim){.known = true,
                             .width = load_32(bytes + WIDTH),
                             .height = load_32(bytes + HEIGHT),
                             .channels = palette ? 3 : channels[bytes[TYPE]],
                             .bits = palette ? 8 : bytes[DEPTH]};
  if (claimed.width <= HL_IMAGE_SIDE_MAX && claimed.height <= HL_IMAGE_SIDE_MAX)
    claimed.bytes = (1 + (claimed.width * channels[bytes[TYPE]] * bytes[DEPTH] + 7) / 8) * claimed.height;
  return claimed;
}

static hl_status decode(hl_context *context, const char *name, const unsigned char *bytes, size_t length,
                        hl_image **image, hl_error *error) {
  png_reading reading = {.context = context, .name = name, .bytes = bytes, .length = length, .error = error};
  reading.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &reading, on_read_error, on_warning, &reading,
                                         on_read_allocate, on_read_release);
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

/* ---- writing ---- */

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

static void on_write_error(png_structp png, png_const_charp message) {
  png_writing *writing = png_get_error_ptr(png);
  if (writing->status == HL_OK)
    writing->status = hl_fail(writing->error, HL_ERROR_INTERNAL, "%s: cannot write: libpng says: %s",
                              writing->output->path, message);
  png_longjmp(png, 1);
}

static png_voidp on_write_allocate(png_structp png, png_alloc_size_t size) {
  png_writing *writing = png_get_mem_ptr(png);
  void *memory = hl_allocate(writing->output->context, size, 1);
  if (memory == NULL) writing->status = hl_fail_memory(writing->error, size, writing->output->path);
  return memory;
}

static void on_write_release(png_structp png, png_voidp memory) {
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

static void write_text(png_writing *writing, const char *key, const char *content) {
  png_text text;
  memset(&text, 0, sizeof text);
  text.compression = PNG_ITXT_COMPRESSION_zTXt;
  text.key = (png_charp)key;
  text.text = (png_charp)content;
  text.itxt_length = strlen(content);
  text.lang = (png_charp) "";
  text.lang_key = (png_charp) "";
  png_set_text(writing->png, writing->info, &text, 1);
}

static void write_texts(png_writing *writing) {
  const char *scene = writing->options->scene_json, *field_errors = writing->options->field_errors;
  if (scene != NULL) write_text(writing, keyword, scene);
  if (scene != NULL && field_errors != NULL) write_text(writing, field_errors_keyword, field_errors);
}

/* Contains all calls of libpng's writer that may longjmp. The struct `writing` stays valid after the jump,
 * and no local variable is used after it. */
static void write_png(png_writing *writing) {
  const hl_image *image = writing->image;
  if (setjmp(png_jmpbuf(writing->png)) != 0) return;
  png_set_write_fn(writing->png, writing, on_write, on_flush);
  png_set_IHDR(writing->png, writing->info, (png_uint_32)image->width, (png_uint_32)image->height,
               writing->options->png_depth,
               writing->options->background_transparent ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(writing->png, writing->info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (writing->options->pixels_per_inch > 0) {
    png_uint_32 per_metre = (png_uint_32)(writing->options->pixels_per_inch / 0.0254 + 0.5);
    png_set_pHYs(writing->png, writing->info, per_metre, per_metre, PNG_RESOLUTION_METER);
  }
  write_texts(writing);
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

static hl_status encode(const hl_image *image, const hl_image_write_options *options, hl_output *output,
                        hl_error *error) {
  png_writing writing = {.image = image, .options = options, .output = output, .error = error};
  hl_status status = hl_codes_begin(output->context, options, options->png_depth, &writing.codes, error);
  if (status != HL_OK) return status;
  size_t row_bytes = (size_t)image->width * 4 * (size_t)(options->png_depth / 8);
  writing.row = hl_allocate(output->context, row_bytes, 1);
  writing.png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &writing, on_write_error, on_warning,
                                          &writing, on_write_allocate, on_write_release);
  writing.info = writing.png == NULL ? NULL : png_create_info_struct(writing.png);
  if (writing.row == NULL || writing.info == NULL)
    writing.status = hl_fail_memory(error, row_bytes, output->path);
  else write_png(&writing);
  png_destroy_write_struct(&writing.png, &writing.info);
  hl_release(output->context, writing.row);
  hl_codes_end(&writing.codes);
  return writing.status;
}

const hl_image_format hl_png_format = {
    .extension = ".png",
    .title = "PNG",
    .mark = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'},
    .mark_length = MARK_BYTES,
    .encode = encode,
    .decode = decode,
    .claim = claim,
};

/* ---- the scene ----
 *
 * Chunks are read without libpng, so that the picture itself need not be decoded. The chunks are tEXt, zTXt
 * and iTXt (PNG specification, sections 11.3.4.3 to 11.3.4.5). The texts of zTXt and iTXt chunks are inflated
 * to at most SCENE_BYTES_MOST bytes. */

enum { SCENE_BYTES_MOST = 16 << 20, CHUNK_EXTRA_BYTES = 12 };

static void *zlib_allocate(void *context, unsigned items, unsigned size) {
  return hl_allocate(context, items, size);
}
static void zlib_release(void *context, void *memory) { hl_release(context, memory); }

static hl_status copy_text(hl_context *context, const char *name, const unsigned char *bytes, size_t length,
                           char **text, hl_error *error) {
  if (length > SCENE_BYTES_MOST)
    return hl_fail(error, HL_ERROR_INPUT, "%s: its scene has %zu bytes: at most %d are read", name, length,
                   SCENE_BYTES_MOST);
  *text = hl_allocate(context, length + 1, 1);
  if (*text == NULL) return hl_fail_memory(error, length + 1, name);
  memcpy(*text, bytes, length);
  (*text)[length] = 0;
  return HL_OK;
}

/* Inflates the text of a chunk into a buffer, whose size is doubled until the text ends or the limit is
 * reached. */
static hl_status inflate_text(hl_context *context, const char *name, const unsigned char *bytes,
                              size_t length, char **text, hl_error *error) {
  z_stream zlib = {.zalloc = zlib_allocate, .zfree = zlib_release, .opaque = context};
  if (inflateInit(&zlib) != Z_OK) return hl_fail_memory(error, 65536, name);
  size_t capacity = 65536, made = 0;
  char *buffer = hl_allocate(context, capacity, 1);
  zlib.next_in = (unsigned char *)bytes;
  zlib.avail_in = (unsigned)length;
  int code = Z_OK;
  while (buffer != NULL && code == Z_OK && capacity <= 2 * (size_t)SCENE_BYTES_MOST) {
    zlib.next_out = (unsigned char *)buffer + made;
    zlib.avail_out = (unsigned)(capacity - 1 - made);
    code = inflate(&zlib, Z_NO_FLUSH);
    made = capacity - 1 - zlib.avail_out;
    if (code != Z_OK || zlib.avail_out > 0) continue;
    char *larger = hl_reallocate(context, buffer, capacity * 2, 1);
    if (larger == NULL) hl_release(context, buffer);
    buffer = larger;
    capacity *= 2;
  }
  inflateEnd(&zlib);
  if (buffer == NULL) return hl_fail_memory(error, capacity, name);
  if (code == Z_STREAM_END) {
    buffer[made] = 0;
    *text = buffer;
    return HL_OK;
  }
  hl_release(context, buffer);
  if (code == Z_OK)
    return hl_fail(error, HL_ERROR_INPUT, "%s: its scene has more than %d bytes", name, SCENE_BYTES_MOST);
  return hl_fail(error, HL_ERROR_INPUT, "%s: the scene in it is damaged: zlib data expected", name);
}

/* Reads the text of a chunk that has the wanted keyword. body: the chunk's bytes after the keyword's zero
 * byte. */
static hl_status take_text(hl_context *context, const char *name, const char *type, const unsigned char *body,
                           size_t length, char **text, hl_error *error) {
  if (memcmp(type, "tEXt", 4) == 0) return copy_text(context, name, body, length, text, error);
  if (memcmp(type, "zTXt", 4) == 0 && length > 1)
    return inflate_text(context, name, body + 1, length - 1, text, error);
  /* an iTXt chunk has a flag for compression, the method, the language and the translated keyword; language
   * and translated keyword each end with a zero byte */
  const unsigned char *language_end = length > 2 ? memchr(body + 2, 0, length - 2) : NULL;
  const unsigned char *end = body + length;
  const unsigned char *start = language_end != NULL
                                   ? memchr(language_end + 1, 0, (size_t)(end - language_end - 1))
                                   : NULL;
  if (start == NULL)
    return hl_fail(error, HL_ERROR_INPUT, "%s: the scene in it is damaged: its chunk is cut short", name);
  start++;
  return body[0] != 0 ? inflate_text(context, name, start, (size_t)(end - start), text, error)
                      : copy_text(context, name, start, (size_t)(end - start), text, error);
}

/* The position, type and content of a chunk in the file. */
typedef struct png_chunk {
  size_t at;                 /* offset of the chunk's length */
  const char *type;          /* [4]; the chunk's type, such as "tEXt" */
  const unsigned char *body; /* [length]; the chunk's content */
  size_t length;
} png_chunk;

/* Finds the text chunk with the keyword `word`, which has `size` bytes including its zero. Returns false if
 * no chunk has the keyword. */
static bool find_chunk(const unsigned char *bytes, size_t byte_count, const char *word, size_t size,
                       png_chunk *chunk) {
  if (byte_count < MARK_BYTES || memcmp(bytes, hl_png_format.mark, MARK_BYTES) != 0) return false;
  for (size_t at = MARK_BYTES; byte_count - at >= CHUNK_EXTRA_BYTES;) {
    *chunk = (png_chunk){at, (const char *)bytes + at + 4, bytes + at + 8, load_32(bytes + at)};
    if (chunk->length > byte_count - at - CHUNK_EXTRA_BYTES) return false;
    bool is_text = memcmp(chunk->type, "tEXt", 4) == 0 || memcmp(chunk->type, "zTXt", 4) == 0 ||
                   memcmp(chunk->type, "iTXt", 4) == 0;
    if (is_text && chunk->length >= size && memcmp(chunk->body, word, size) == 0) return true;
    at += chunk->length + CHUNK_EXTRA_BYTES;
  }
  return false;
}

bool hl_png_has_scene(const unsigned char *bytes, size_t length) {
  png_chunk chunk;
  return find_chunk(bytes, length, keyword, sizeof keyword, &chunk);
}

/* Reads the text of a chunk. size: the number of bytes of the chunk's keyword including its zero. */
static hl_status read_chunk(hl_context *context, const char *name, const png_chunk *chunk, size_t size,
                            char **text, hl_error *error) {
  if (crc32(crc32(0, NULL, 0), (const unsigned char *)chunk->type, (unsigned)(chunk->length + 4)) !=
      load_32(chunk->body + chunk->length))
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)chunk->at,
                          "%s: byte %zu: the scene in it is damaged: its sum is wrong", name, chunk->at);
  return take_text(context, name, chunk->type, chunk->body + size, chunk->length - size, text, error);
}

hl_status hl_image_find_field_errors(hl_context *context, const char *name, const void *bytes,
                                     size_t byte_count, char **text, hl_error *error) {
  HL_DOOR;
  png_chunk chunk;
  if (context == NULL || name == NULL || bytes == NULL || text == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_image_find_field_errors: context, name, bytes and text must not be null");
  *text = NULL;
  if (!find_chunk(bytes, byte_count, field_errors_keyword, sizeof field_errors_keyword, &chunk)) return HL_OK;
  return read_chunk(context, name, &chunk, sizeof field_errors_keyword, text, error);
}

hl_status hl_image_find_scene(hl_context *context, const char *name, const void *file, size_t file_bytes,
                              char **text, hl_error *error) {
  png_chunk chunk;
  if (context == NULL || name == NULL || file == NULL || text == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_image_find_scene: context, name, bytes and text must not be null");
  *text = NULL;
  if (file_bytes < MARK_BYTES || memcmp(file, hl_png_format.mark, MARK_BYTES) != 0)
    return hl_fail_offset(error, HL_ERROR_INPUT, 0,
                          "%s: byte 0: not a PNG picture, which alone carries a scene", name);
  if (find_chunk(file, file_bytes, keyword, sizeof keyword, &chunk))
    return read_chunk(context, name, &chunk, sizeof keyword, text, error);
  return hl_fail(error, HL_ERROR_INPUT,
                 "%s: a picture without a scene in it: those that halflight render writes as .png have one",
                 name);
}
