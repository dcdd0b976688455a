/* image/npy.c - reads and writes pictures as NumPy arrays (NPY format), float32, C order.
 *
 * Files are written in version 1.0 with elements '<f4'. A picture has the shape height x width x 4; a layer
 * has the shape height x width x channels, or height x width if it has one channel. Files are read in
 * versions 1 to 3, with elements '<f4' or '<f8' and the shapes height x width and height x width x 1, 3 or 4.
 * Grey is copied to R, G and B, and a missing alpha is 1. Values of '<f4' keep all their bits.
 *
 * The header is a Python literal: {'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 4), } */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "image/format.h"

/* HEADER_BYTES is a multiple of 64, because NumPy, too, lets the data of its files start at a multiple of
 * 64. */
enum { PREAMBLE_BYTES = 10, HEADER_BYTES = 128, HEADER_BYTES_MAX = 65536 };

typedef struct npy_header {
  char type[8]; /* the type of the elements, such as "<f4" */
  bool fortran_order;
  uint64_t shape[3]; /* the array's shape: height, width, channels */
  int dimensions;
  bool has_type, has_order, has_shape;
} npy_header;

/* The position at which the header's text is read. Errors name the byte in the file at the read position. */
typedef struct npy_cursor {
  const char *name;
  const unsigned char *bytes; /* borrowed; the first bytes of the file */
  size_t at, end;             /* at: the read position; end: the end of the header's text */
  hl_error *error;
} npy_cursor;

/* ---- writing ---- */

static void put_float(unsigned char *to, float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  for (int i = 0; i < 4; i++) to[i] = (unsigned char)(bits >> 8 * i);
}

/* The array to write: [height][width][channels], or [height][width] if the number of channels is 1. */
typedef struct npy_array {
  int height, width;
  size_t channels;
  const float *values; /* borrowed; the values that are written */
} npy_array;

static void make_header(const npy_array *array, unsigned char header[HEADER_BYTES + 1]) {
  memcpy(header, "\x93NUMPY\x01\x00", 8);
  header[8] = HEADER_BYTES - PREAMBLE_BYTES;
  header[9] = 0;
  char text[HEADER_BYTES - PREAMBLE_BYTES], channels[24] = "";
  if (array->channels > 1) snprintf(channels, sizeof channels, ", %zu", array->channels);
  snprintf(text, sizeof text, "{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d%s), }",
           array->height, array->width, channels);
  snprintf((char *)header + PREAMBLE_BYTES, HEADER_BYTES - PREAMBLE_BYTES + 1, "%-*s\n",
           HEADER_BYTES - PREAMBLE_BYTES - 1, text);
}

static hl_status encode_array(const npy_array *array, hl_output *output, hl_error *error) {
  size_t row_floats = (size_t)array->width * array->channels;
  unsigned char header[HEADER_BYTES + 1], *row = hl_allocate(output->context, row_floats, 4);
  if (row == NULL) return hl_fail_memory(error, row_floats * 4, output->path);
  make_header(array, header);
  errno = 0;
  bool written = fwrite(header, 1, HEADER_BYTES, output->file) == HEADER_BYTES;
  hl_status status = HL_OK;
  for (int y = 0; y < array->height && written && status == HL_OK; y++) {
    status = hl_encode_step(output->context, y, array->height, error);
    if (status != HL_OK) break;
    for (size_t i = 0; i < row_floats; i++) put_float(row + 4 * i, array->values[(size_t)y * row_floats + i]);
    errno = 0;
    written = fwrite(row, 4, row_floats, output->file) == row_floats;
  }
  if (!written) status = hl_fail_write(error, output, errno);
  hl_release(output->context, row);
  return status;
}

static hl_status encode(const hl_image *image, const hl_image_write_options *options, hl_output *output,
                        hl_error *error) {
  (void)options; /* depth and background have no effect on NPY files */
  const npy_array array = {image->height, image->width, 4, image->pixels};
  return encode_array(&array, output, error);
}

static hl_status encode_layer(const hl_image *image, const hl_image_layer *layer, hl_output *output,
                              hl_error *error) {
  const npy_array array = {image->height, image->width, strlen(layer->channels), layer->values};
  return encode_array(&array, output, error);
}

/* ---- reading the header ---- */

static hl_status fail_header(const npy_cursor *cursor, const char *expected) {
  return hl_fail_offset(cursor->error, HL_ERROR_INPUT, (int64_t)cursor->at,
                        "%s: byte %zu: damaged NPY header: expected %s", cursor->name, cursor->at, expected);
}

static void skip_spaces(npy_cursor *cursor) {
  while (cursor->at < cursor->end && memchr(" \t\r\n", cursor->bytes[cursor->at], 4) != NULL) cursor->at++;
}

/* Moves behind a given text of the header if this text comes next in the header. */
static bool take(npy_cursor *cursor, const char *text) {
  skip_spaces(cursor);
  size_t length = strlen(text);
  if (cursor->end - cursor->at < length || memcmp(cursor->bytes + cursor->at, text, length) != 0)
    return false;
  cursor->at += length;
  return true;
}

/* Reads a quoted string without escapes from the header. A string that is too long for `text` is cut off. */
static bool take_string(npy_cursor *cursor, char *text, size_t size) {
  const char *quote = take(cursor, "'") ? "'" : take(cursor, "\"") ? "\"" : NULL;
  if (quote == NULL) return false;
  size_t start = cursor->at, length;
  while (cursor->at < cursor->end && cursor->bytes[cursor->at] != (unsigned char)*quote) cursor->at++;
  if (cursor->at == cursor->end) return false;
  length = cursor->at++ - start;
  if (length > size - 1) length = size - 1;
  memcpy(text, cursor->bytes + start, length);
  text[length] = 0;
  return true;
}

static bool take_count(npy_cursor *cursor, uint64_t *count) {
  skip_spaces(cursor);
  size_t start = cursor->at;
  *count = 0;
  while (cursor->at < cursor->end && cursor->bytes[cursor->at] >= '0' && cursor->bytes[cursor->at] <= '9') {
    /* No size of a file has more than 18 digits. */
    if (cursor->at - start == 18) return false;
    *count = *count * 10 + (uint64_t)(cursor->bytes[cursor->at++] - '0');
  }
  return cursor->at > start;
}

static hl_status take_shape(npy_cursor *cursor, npy_header *header) {
  if (!take(cursor, "(")) return fail_header(cursor, "a shape such as (512, 512, 4)");
  while (!take(cursor, ")")) {
    uint64_t count;
    if (!take_count(cursor, &count)) return fail_header(cursor, "a count of elements, or ')'");
    if (header->dimensions < 3) header->shape[header->dimensions] = count;
    header->dimensions++;
    if (!take(cursor, ",") && (cursor->at == cursor->end || cursor->bytes[cursor->at] != ')'))
      return fail_header(cursor, "',' or ')'");
  }
  header->has_shape = true;
  return HL_OK;
}

static hl_status take_entry(npy_cursor *cursor, npy_header *header) {
  char key[16];
  if (!take_string(cursor, key, sizeof key)) return fail_header(cursor, "a key in quotes");
  if (!take(cursor, ":")) return fail_header(cursor, "':' after the key");
  if (strcmp(key, "shape") == 0 && !header->has_shape) return take_shape(cursor, header);
  if (strcmp(key, "descr") == 0) {
    if (!take_string(cursor, header->type, sizeof header->type))
      return fail_header(cursor, "a type such as '<f4'");
    header->has_type = true;
    return HL_OK;
  }
  if (strcmp(key, "fortran_order") == 0) {
    header->fortran_order = take(cursor, "True");
    if (!header->fortran_order && !take(cursor, "False")) return fail_header(cursor, "True or False");
    header->has_order = true;
    return HL_OK;
  }
  return fail_header(cursor, "the keys descr, fortran_order and shape, each once");
}

static hl_status parse_header(npy_cursor *cursor, npy_header *header) {
  if (!take(cursor, "{")) return fail_header(cursor, "'{'");
  while (!take(cursor, "}")) {
    hl_status status = take_entry(cursor, header);
    if (status != HL_OK) return status;
    if (!take(cursor, ",") && (cursor->at == cursor->end || cursor->bytes[cursor->at] != '}'))
      return fail_header(cursor, "',' or '}'");
  }
  if (!header->has_type || !header->has_order || !header->has_shape)
    return fail_header(cursor, "the keys descr, fortran_order and shape");
  return HL_OK;
}

/* Finds the header's text and the first byte of data behind it. */
static hl_status find_header(npy_cursor *cursor, size_t length) {
  const unsigned char *bytes = cursor->bytes;
  if (length < PREAMBLE_BYTES + 2) return fail_header(cursor, "more than an empty file");
  int version = bytes[6];
  if (version < 1 || version > 3)
    return hl_fail_offset(cursor->error, HL_ERROR_UNSUPPORTED, 6,
                          "%s: byte 6: NPY version %d, expected 1, 2 or 3", cursor->name, version);
  size_t text_bytes = bytes[8] | (size_t)bytes[9] << 8;
  if (version > 1) text_bytes |= (size_t)bytes[10] << 16 | (size_t)bytes[11] << 24;
  cursor->at = version == 1 ? PREAMBLE_BYTES : PREAMBLE_BYTES + 2;
  if (text_bytes > HEADER_BYTES_MAX || text_bytes > length - cursor->at)
    return fail_header(cursor, "a header that ends within the file");
  cursor->end = cursor->at + text_bytes;
  return HL_OK;
}

static hl_status check_header(const npy_cursor *cursor, npy_header *header) {
  if (strcmp(header->type, "<f4") != 0 && strcmp(header->type, "<f8") != 0)
    return hl_fail(cursor->error, HL_ERROR_UNSUPPORTED,
                   "%s: element type '%s', expected '<f4' or '<f8': convert with .astype('<f4')",
                   cursor->name, header->type);
  if (header->fortran_order)
    return hl_fail(cursor->error, HL_ERROR_UNSUPPORTED,
                   "%s: Fortran order, expected C order: convert with numpy.ascontiguousarray", cursor->name);
  if (header->dimensions == 2) header->shape[2] = 1;
  bool channels_fit = header->shape[2] == 1 || header->shape[2] == 3 || header->shape[2] == 4;
  if (header->dimensions < 2 || header->dimensions > 3 || !channels_fit)
    return hl_fail(cursor->error, HL_ERROR_UNSUPPORTED,
                   "%s: an array of %d dimensions%s, expected height x width, or height x width x 1, 3 or 4",
                   cursor->name, header->dimensions, header->dimensions == 3 ? " with another last one" : "");
  return HL_OK;
}

/* ---- reading the data ---- */

static float take_float(const unsigned char *from, size_t bytes) {
  uint64_t bits = 0;
  for (size_t i = 0; i < bytes; i++) bits |= (uint64_t)from[i] << 8 * i;
  if (bytes == 8) {
    double wide;
    memcpy(&wide, &bits, sizeof wide);
    return (float)wide;
  }
  uint32_t low = (uint32_t)bits;
  float value;
  memcpy(&value, &low, sizeof value);
  return value;
}

static void convert_row(const unsigned char *from, size_t value_bytes, uint64_t channels, int y,
                        hl_image *image) {
  float *pixel = image->pixels + (size_t)y * (size_t)image->width * 4;
  for (int x = 0; x < image->width; x++, pixel += 4) {
    for (uint64_t c = 0; c < channels; c++, from += value_bytes) pixel[c] = take_float(from, value_bytes);
    if (channels == 1) pixel[1] = pixel[2] = pixel[0];
    if (channels < 4) pixel[3] = 1;
  }
}

static hl_image_claim claim(const unsigned char *bytes, size_t length) {
  npy_cursor cursor = {.name = "", .bytes = bytes};
  npy_header header = {0};
  hl_image_claim claimed = {0};
  if (find_header(&cursor, length) != HL_OK || parse_header(&cursor, &header) != HL_OK ||
      check_header(&cursor, &header) != HL_OK)
    return claimed;
  claimed = (hl_image_claim){.known = true,
                             .width = header.shape[1],
                             .height = header.shape[0],
                             .channels = (int)header.shape[2],
                             .bits = header.type[2] == '8' ? 64 : 32};
  if (claimed.width <= HL_IMAGE_SIDE_MAX && claimed.height <= HL_IMAGE_SIDE_MAX)
    claimed.bytes = claimed.width * claimed.height * header.shape[2] * (header.type[2] == '8' ? 8 : 4);
  return claimed;
}

static hl_status decode(hl_context *context, const char *name, const unsigned char *bytes, size_t length,
                        hl_image **image, hl_error *error) {
  npy_cursor cursor = {.name = name, .bytes = bytes, .error = error};
  npy_header header = {0};
  hl_status status = find_header(&cursor, length);
  if (status == HL_OK) status = parse_header(&cursor, &header);
  if (status == HL_OK) status = check_header(&cursor, &header);
  if (status != HL_OK) return status;
  size_t value_bytes = header.type[2] == '8' ? 8 : 4, data = cursor.end;
  uint64_t rest = length - data, row = header.shape[1] * header.shape[2] * value_bytes;
  bool right_size = header.shape[0] <= HL_IMAGE_SIDE_MAX && header.shape[1] <= HL_IMAGE_SIDE_MAX;
  right_size = !right_size || header.shape[0] * row == rest; /* the checks that follow refuse sizes that are
                                                              * too great */
  if (!right_size)
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)data,
                          "%s: byte %zu: %" PRIu64 " bytes of data, expected %" PRIu64 " for %" PRIu64
                          " x %" PRIu64 " x %" PRIu64 " %s",
                          name, data, rest, header.shape[0] * row, header.shape[0], header.shape[1],
                          header.shape[2], value_bytes == 8 ? "doubles" : "floats");
  status = hl_image_create_for_file(context, name, header.shape[1], header.shape[0], image, error);
  for (int y = 0; status == HL_OK && y < (*image)->height; y++) {
    convert_row(bytes + data + (size_t)y * row, value_bytes, header.shape[2], y, *image);
    if (hl_cancelled(context)) status = hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", name);
  }
  if (status == HL_OK) return HL_OK;
  hl_image_destroy(*image);
  *image = NULL;
  return status;
}

const hl_image_format hl_npy_format = {
    .extension = ".npy",
    .title = "NPY",
    .mark = {0x93, 'N', 'U', 'M', 'P', 'Y'},
    .mark_length = 6,
    .encode = encode,
    .decode = decode,
    .claim = claim,
    .encode_layer = encode_layer,
};
