/* image/hdr.c - reads pictures in Radiance's format (.hdr, .pic). Most of these pictures are environments.
 * Pictures are not written in this format.
 *
 * In: bytes. Out: a picture of linear light, with alpha 1. Sources: Ward, "Real pixels", Graphics Gems II
 * (1991), and Radiance's refman/filefmts.pdf. The header consists of lines, of which the first is
 * "#?RADIANCE" and the last is empty. After the header, a line states the picture's size, such as "-Y 512 +X
 * 1024" for rows from the top with pixels from the left. Rows of RGBE pixels follow, which have three
 * mantissas and an exponent. A row is stored plainly, as runs of whole pixels, or as runs of each of the four
 * numbers separately.
 *
 * As in most programs, the line EXPOSURE is ignored, and the picture has the stored values. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "image/format.h"

enum { LINE_MAX_BYTES = 2048, RUN_WIDTH_MIN = 8, RUN_WIDTH_MAX = 32767, RUN_MAX = 127, EXPONENTS = 256 };

/* The position at which a file is read. Errors name the byte at the read position. */
typedef struct hdr_cursor {
  const char *name;
  const unsigned char *bytes; /* borrowed; [length]; the bytes of the file */
  size_t at, length;
  hl_error *error;
} hdr_cursor;

typedef struct hdr_header {
  uint64_t width, height;
  bool from_below, from_right; /* whether the lowest row comes first, and whether the rightmost pixel of each
                                * row comes first */
} hdr_header;

static hl_status fail_at(const hdr_cursor *cursor, hl_status status, const char *what) {
  return hl_fail_offset(cursor->error, status, (int64_t)cursor->at, "%s: byte %zu: %s", cursor->name,
                        cursor->at, what);
}

static hl_status fail_end(const hdr_cursor *cursor) {
  return fail_at(cursor, HL_ERROR_INPUT, "the file ends within the picture: it is cut off or damaged");
}

/* ---- the header ---- */

/* Copies the next line of the header without its end. Returns false if the file ends before the line does, or
 * the line is too long. */
static bool take_line(hdr_cursor *cursor, char line[LINE_MAX_BYTES]) {
  size_t most = cursor->length - cursor->at;
  const unsigned char *from = cursor->bytes + cursor->at, *end = memchr(from, '\n', most);
  if (end == NULL || end - from >= LINE_MAX_BYTES) return false;
  size_t count = (size_t)(end - from);
  memcpy(line, from, count);
  line[count] = 0;
  cursor->at += count + 1;
  return true;
}

/* Skips the header's lines, including the empty line at its end. */
static hl_status skip_header(hdr_cursor *cursor) {
  char line[LINE_MAX_BYTES];
  for (;;) {
    size_t start = cursor->at;
    if (!take_line(cursor, line))
      return fail_at(cursor, HL_ERROR_INPUT,
                     "damaged Radiance header: expected lines of text, then an empty one");
    if (line[0] == 0) return HL_OK;
    if (strncmp(line, "FORMAT=", 7) != 0 || strcmp(line + 7, "32-bit_rle_rgbe") == 0) continue;
    cursor->at = start;
    return fail_at(cursor, HL_ERROR_UNSUPPORTED,
                   "only FORMAT=32-bit_rle_rgbe is read: convert the picture to OpenEXR");
  }
}

/* Reads a size with its axis, such as "-Y 512" or "+X 1024", and moves *text behind the size. */
static bool take_extent(const char **text, char axis, char *sign, uint64_t *count) {
  const char *at = *text;
  *sign = *at;
  if ((*sign != '+' && *sign != '-') || *++at != axis || *++at != ' ') return false;
  size_t digits = strspn(++at, "0123456789");
  if (digits == 0 || digits > 18) return false;
  *count = 0;
  for (size_t n = 0; n < digits; n++) *count = 10 * *count + (uint64_t)(at[n] - '0');
  *text = at + digits;
  return true;
}

static hl_status read_header(hdr_cursor *cursor, hdr_header *header) {
  char line[LINE_MAX_BYTES];
  hl_status status = skip_header(cursor);
  if (status != HL_OK) return status;
  size_t start = cursor->at;
  if (!take_line(cursor, line)) return fail_end(cursor);
  const char *text = line;
  char vertical, horizontal;
  bool read = take_extent(&text, 'Y', &vertical, &header->height) && *text++ == ' ' &&
              take_extent(&text, 'X', &horizontal, &header->width) && *text == 0;
  if (read) {
    header->from_below = vertical == '+';
    header->from_right = horizontal == '-';
    return HL_OK;
  }
  cursor->at = start;
  return fail_at(cursor, HL_ERROR_UNSUPPORTED,
                 "expected the picture's size, such as -Y 512 +X 1024 (rows, then columns)");
}

/* ---- rows ---- */

/* A row of RGBE pixels, as four rows of bytes: red, green, blue and exponents. */
typedef struct hdr_row {
  unsigned char *bytes; /* [4][width]; the bytes of red, green, blue and the exponents */
  size_t width;
} hdr_row;

static bool in_runs(const hdr_cursor *cursor, size_t width) {
  const unsigned char *at = cursor->bytes + cursor->at;
  return width >= RUN_WIDTH_MIN && width <= RUN_WIDTH_MAX && cursor->length - cursor->at >= 4 && at[0] == 2 &&
         at[1] == 2 && at[2] < 128;
}

/* Reads one of the four rows of bytes that make a row of pixels. Each run begins with a count. A count n
 * above 128 repeats the next byte n - 128 times; any other count n is followed by n single bytes. */
static hl_status take_runs(hdr_cursor *cursor, unsigned char *to, size_t width) {
  for (size_t x = 0; x < width;) {
    if (cursor->length - cursor->at < 2) return fail_end(cursor);
    size_t count = cursor->bytes[cursor->at], repeats = count > 128;
    if (repeats) count -= 128;
    if (count == 0 || count > width - x)
      return fail_at(cursor, HL_ERROR_INPUT, "damaged picture: a run that does not fit its row");
    size_t used = repeats ? 1 : count;
    if (cursor->length - cursor->at - 1 < used) return fail_end(cursor);
    const unsigned char *from = cursor->bytes + cursor->at + 1;
    if (repeats) memset(to + x, *from, count);
    else memcpy(to + x, from, count);
    cursor->at += 1 + used;
    x += count;
  }
  return HL_OK;
}

/* Reads a row of whole pixels. The code (1, 1, 1, n) repeats the last pixel n times; a second such code
 * directly after the first repeats the pixel n x 256 times, and so on. */
static hl_status take_pixels(hdr_cursor *cursor, const hdr_row *row) {
  int shift = 0;
  for (size_t x = 0; x < row->width;) {
    if (cursor->length - cursor->at < 4) return fail_end(cursor);
    const unsigned char *from = cursor->bytes + cursor->at;
    const bool repeats = x > 0 && from[0] == 1 && from[1] == 1 && from[2] == 1;
    size_t count = repeats ? (size_t)from[3] << shift : 1;
    if (count > row->width - x || shift > 24)
      return fail_at(cursor, HL_ERROR_INPUT, "damaged picture: a run that does not fit its row");
    for (size_t n = 0; n < count; n++, x++)
      for (size_t c = 0; c < 4; c++)
        row->bytes[c * row->width + x] = repeats ? row->bytes[c * row->width + x - 1] : from[c];
    shift = repeats ? shift + 8 : 0;
    cursor->at += 4;
  }
  return HL_OK;
}

static hl_status take_row(hdr_cursor *cursor, const hdr_row *row) {
  if (!in_runs(cursor, row->width)) return take_pixels(cursor, row);
  const unsigned char *at = cursor->bytes + cursor->at;
  if (((size_t)at[2] << 8 | at[3]) != row->width)
    return fail_at(cursor, HL_ERROR_INPUT, "damaged picture: a row of another length than the picture's");
  cursor->at += 4;
  hl_status status = HL_OK;
  for (size_t c = 0; c < 4 && status == HL_OK; c++)
    status = take_runs(cursor, row->bytes + c * row->width, row->width);
  return status;
}

/* Converts a row of RGBE pixels to floats. A mantissa m with the exponent e is m 2^(e - 136); an exponent of
 * 0 is black. */
static void convert_row(const hdr_row *row, const float scale[EXPONENTS], bool from_right, float *to) {
  for (size_t x = 0; x < row->width; x++) {
    float *pixel = to + 4 * (from_right ? row->width - 1 - x : x);
    for (size_t c = 0; c < 3; c++)
      pixel[c] = (float)row->bytes[c * row->width + x] * scale[row->bytes[3 * row->width + x]];
    pixel[3] = 1;
  }
}

/* ---- the picture ---- */

/* The least number of bytes of the rows of a picture of the size that the header states. A plain row and a
 * row with runs of whole pixels begin with at least one pixel of 4 bytes. */
static uint64_t least_bytes(const hdr_cursor *cursor, const hdr_header *header) {
  uint64_t row = 4;
  if (in_runs(cursor, (size_t)header->width)) row += 8 * ((header->width + RUN_MAX - 1) / RUN_MAX);
  return header->height * row;
}

static hl_image_claim claim(const unsigned char *bytes, size_t length) {
  hdr_cursor cursor = {.name = "", .bytes = bytes, .length = length};
  hdr_header header = {0};
  hl_image_claim claimed = {0};
  if (read_header(&cursor, &header) != HL_OK) return claimed;
  claimed = (hl_image_claim){
      .known = true, .width = header.width, .height = header.height, .channels = 3, .bits = 8};
  if (claimed.width <= HL_IMAGE_SIDE_MAX && claimed.height <= HL_IMAGE_SIDE_MAX)
    claimed.bytes = claimed.width * claimed.height * 4;
  return claimed;
}

static hl_status decode_rows(hdr_cursor *cursor, const hdr_header *header, hl_context *context,
                             hl_image *image) {
  const size_t width = (size_t)image->width, height = (size_t)image->height;
  float scale[EXPONENTS] = {0};
  for (int e = 1; e < EXPONENTS; e++) scale[e] = (float)ldexp(1, e - 136);
  hdr_row row = {hl_allocate(context, width, 4), width};
  if (row.bytes == NULL) return hl_fail_memory(cursor->error, 4 * (uint64_t)width, cursor->name);
  hl_status status = HL_OK;
  for (size_t y = 0; y < height && status == HL_OK; y++) {
    status = take_row(cursor, &row);
    size_t at = header->from_below ? height - 1 - y : y;
    if (status == HL_OK) convert_row(&row, scale, header->from_right, image->pixels + 4 * width * at);
    if (status == HL_OK && hl_cancelled(context))
      status = hl_fail(cursor->error, HL_ERROR_CANCELLED, "%s: cancelled", cursor->name);
  }
  hl_release(context, row.bytes);
  return status;
}

static hl_status decode(hl_context *context, const char *name, const unsigned char *bytes, size_t length,
                        hl_image **image, hl_error *error) {
  hdr_cursor cursor = {.name = name, .bytes = bytes, .length = length, .error = error};
  hdr_header header = {0};
  hl_status status = read_header(&cursor, &header);
  if (status == HL_OK) status = hl_image_check_size(name, header.width, header.height, error);
  if (status == HL_OK && least_bytes(&cursor, &header) > length - cursor.at) status = fail_end(&cursor);
  if (status == HL_OK)
    status = hl_image_create_for_file(context, name, header.width, header.height, image, error);
  if (status != HL_OK) return status;
  status = decode_rows(&cursor, &header, context, *image);
  if (status == HL_OK) return HL_OK;
  hl_image_destroy(*image);
  *image = NULL;
  return status;
}

const hl_image_format hl_hdr_format = {
    .extension = ".hdr",
    .title = "Radiance HDR",
    .mark = {'#', '?'},
    .mark_length = 2,
    .decode = decode,
    .claim = claim,
};
