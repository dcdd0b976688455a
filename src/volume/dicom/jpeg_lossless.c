/* volume/dicom/jpeg_lossless.c - lossless JPEG with Huffman codes, process 14: no library of Debian reads it.
 *
 * Source: ITU-T T.81. Markers: annex B. Codes: annexes C and F.2.2. Prediction: annex H. */
#include <string.h>

#include "core/error.h"
#include "core/memory.h"
#include "volume/dicom/codecs.h"

enum { COMPONENTS_MOST = 3, TABLES = 4, LOOK_BITS = 9 };

typedef struct huffman_table {
  bool known;
  unsigned char values[256];
  int greatest[17];              /* the greatest code of each length; -1: there is none */
  int first[17];                 /* code - first[length] is the index of the code's value */
  uint16_t look[1 << LOOK_BITS]; /* by the next LOOK_BITS bits: length << 8 | value of a code; 0: the code is
                                    longer */
} huffman_table;

typedef struct component {
  int id, table;
} component;

typedef struct decoder {
  const hl_dicom_packed *packed;
  const unsigned char *bytes;
  size_t length, at;
  uint64_t bits; /* the bits that come next: bit `bit_count` - 1 first, bit 0 last */
  int bit_count;
  size_t missing;                  /* bytes read beyond the end */
  int precision, predictor, shift; /* shift: the point transform */
  size_t rows, columns, components, restart;
  component component[COMPONENTS_MOST];
  huffman_table table[TABLES];
} decoder;

static hl_status refuse(const decoder *d, const char *why, hl_error *error) {
  return hl_dicom_fail_packed(d->packed, "lossless JPEG", why, error);
}

/* ---- headers ---- */

/* T.81, figures C.1 and C.2: codes of each length follow each other. */
static void make_codes(huffman_table *table, const unsigned char *counts) {
  int code = 0, index = 0;
  memset(table->look, 0, sizeof table->look);
  for (int length = 1; length <= 16; length++) {
    table->first[length] = code - index;
    for (int n = 0; n < counts[length - 1]; n++, code++, index++)
      for (int tail = 0; length <= LOOK_BITS && tail < 1 << (LOOK_BITS - length); tail++) {
        int place = code << (LOOK_BITS - length) | tail;
        if (place < 1 << LOOK_BITS) table->look[place] = (uint16_t)(length << 8 | table->values[index]);
      }
    table->greatest[length] = counts[length - 1] > 0 ? code - 1 : -1;
    code <<= 1;
  }
  table->known = true;
}

static hl_status take_tables(decoder *d, const unsigned char *bytes, size_t length, hl_error *error) {
  while (length >= 17) {
    size_t count = 0;
    for (int n = 1; n <= 16; n++) count += bytes[n];
    if ((bytes[0] & 15) >= TABLES || count > 256 || count > length - 17)
      return refuse(d, "a table of codes is damaged", error);
    huffman_table *table = &d->table[bytes[0] & 15];
    memset(table->values, 0, sizeof table->values);
    memcpy(table->values, bytes + 17, count);
    make_codes(table, bytes + 1);
    bytes += 17 + count;
    length -= 17 + count;
  }
  return HL_OK;
}

static hl_status take_frame(decoder *d, const unsigned char *bytes, size_t length, hl_error *error) {
  if (length < 6 || length < 6 + 3 * (size_t)bytes[5])
    return refuse(d, "its frame header is too short", error);
  d->precision = bytes[0];
  d->rows = (size_t)bytes[1] << 8 | bytes[2];
  d->columns = (size_t)bytes[3] << 8 | bytes[4];
  d->components = bytes[5];
  hl_status status = hl_dicom_check_packed(d->packed, "lossless JPEG", d->columns, d->rows, d->components,
                                           d->precision, error);
  if (status != HL_OK) return status;
  if (d->precision < 2) return refuse(d, "its samples have fewer than 2 bits", error);
  for (size_t c = 0; c < d->components; c++) {
    if (bytes[7 + 3 * c] != 0x11) return refuse(d, "its components differ in size", error);
    d->component[c].id = bytes[6 + 3 * c];
  }
  return HL_OK;
}

static hl_status take_scan(decoder *d, const unsigned char *bytes, size_t length, hl_error *error) {
  if (d->components == 0) return refuse(d, "a scan comes before the frame header", error);
  if (length < 1 || bytes[0] != d->components || length < 4 + 2 * (size_t)bytes[0])
    return refuse(d, "its components are not in one scan", error);
  for (size_t c = 0; c < d->components; c++) {
    d->component[c].table = bytes[2 + 2 * c] >> 4;
    if (bytes[1 + 2 * c] != d->component[c].id || d->component[c].table >= TABLES ||
        !d->table[d->component[c].table].known)
      return refuse(d, "a component has no table of codes", error);
  }
  const unsigned char *rest = bytes + 1 + 2 * d->components;
  d->predictor = rest[0];
  d->shift = rest[2] & 15;
  if (d->predictor < 1 || d->predictor > 7 || d->shift >= d->precision)
    return refuse(d, "its predictor is not one of 1 to 7", error);
  return HL_OK;
}

/* Reads marker segments up to the first scan's codes. */
static hl_status read_headers(decoder *d, hl_error *error) {
  for (d->at = 2; d->at + 4 <= d->length;) {
    if (d->bytes[d->at] != 0xff) return refuse(d, "expected a marker", error);
    int marker = d->bytes[d->at + 1];
    if (marker == 0xff) {
      d->at++;
      continue;
    }
    size_t length = (size_t)d->bytes[d->at + 2] << 8 | d->bytes[d->at + 3];
    if (length < 2 || length > d->length - d->at - 2) break;
    const unsigned char *content = d->bytes + d->at + 4;
    hl_status status = HL_OK;
    d->at += 2 + length;
    length -= 2;
    if (marker == 0xc4) status = take_tables(d, content, length, error);
    if (marker == 0xc3) status = take_frame(d, content, length, error);
    if (marker == 0xdd && length >= 2) d->restart = (size_t)content[0] << 8 | content[1];
    if (marker == 0xda) return take_scan(d, content, length, error);
    if (status != HL_OK) return status;
  }
  return refuse(d, "it ends before its pixels", error);
}

/* ---- codes ---- */

/* Fills `bits` up to at least 32 bits; with zeros after a marker or at the end. */
static void fill(decoder *d) {
  while (d->bit_count <= 48) {
    unsigned byte = 0;
    if (d->at < d->length && d->bytes[d->at] != 0xff) byte = d->bytes[d->at++];
    else if (d->at + 1 < d->length && d->bytes[d->at + 1] == 0) {
      byte = 0xff; /* followed by a stuffed zero */
      d->at += 2;
    } else d->missing++;
    d->bits = d->bits << 8 | byte;
    d->bit_count += 8;
  }
}

static unsigned peek(const decoder *d, int count) {
  return (unsigned)(d->bits >> (d->bit_count - count)) & ((1u << count) - 1);
}

/* Decodes one value; -1: no code begins with these bits. At least 32 bits must be in `bits`. */
static int take_code(decoder *d, const huffman_table *table) {
  unsigned look = table->look[peek(d, LOOK_BITS)];
  if (look != 0) {
    d->bit_count -= (int)(look >> 8);
    return (int)(look & 255);
  }
  for (int length = LOOK_BITS + 1; length <= 16; length++) {
    int code = (int)peek(d, length), index = code - table->first[length];
    if (table->greatest[length] < 0 || code > table->greatest[length]) continue;
    d->bit_count -= length;
    return index >= 0 && index < 256 ? table->values[index] : -1;
  }
  return -1;
}

/* The next difference (T.81, table H.2 and figure F.12); false where the codes are damaged. */
static bool take_difference(decoder *d, const huffman_table *table, int *difference) {
  if (d->bit_count < 32) fill(d);
  int category = take_code(d, table);
  if (category < 0 || category > 16) return false;
  *difference = category == 16 ? 32768 : 0;
  if (category == 0 || category == 16) return true;
  int value = (int)peek(d, category);
  d->bit_count -= category;
  *difference = value < 1 << (category - 1) ? value - (1 << category) + 1 : value;
  return true;
}

/* Passes over a restart marker; the bits before it are padding. */
static void take_restart(decoder *d) {
  d->bits = 0;
  d->bit_count = 0;
  while (d->at + 1 < d->length &&
         !(d->bytes[d->at] == 0xff && d->bytes[d->at + 1] >= 0xd0 && d->bytes[d->at + 1] <= 0xd7))
    d->at++;
  if (d->at + 1 < d->length) d->at += 2;
}

/* ---- samples ---- */

/* T.81, table H.1: a is to the left, b above, c above on the left. */
static int predict(int predictor, int a, int b, int c) {
  switch (predictor) {
    case 1: return a;
    case 2: return b;
    case 3: return c;
    case 4: return a + b - c;
    case 5: return a + ((b - c) >> 1);
    case 6: return b + ((a - c) >> 1);
    default: return (a + b) >> 1;
  }
}

/* Decodes a row of samples that lie `step` samples apart. above: the row before; null: a restart came since.
 */
static bool take_row(decoder *d, const uint16_t *above, uint16_t *row) {
  size_t step = d->components;
  for (size_t x = 0; x < d->columns; x++)
    for (size_t c = 0; c < step; c++) {
      size_t n = x * step + c;
      int difference, expected;
      if (!take_difference(d, &d->table[d->component[c].table], &difference)) return false;
      if (above == NULL) expected = x > 0 ? row[n - step] : 1 << (d->precision - d->shift - 1);
      else if (x == 0) expected = above[n];
      else expected = predict(d->predictor, row[n - step], above[n], above[n - step]);
      row[n] = (uint16_t)(expected + difference);
    }
  return true;
}

static void store_row(const decoder *d, const uint16_t *row, size_t y, void *values) {
  size_t count = d->columns * d->components;
  for (size_t n = 0; n < count; n++) {
    unsigned value = (unsigned)row[n] << d->shift;
    if (d->packed->pixels->allocated > 8) ((uint16_t *)values)[y * count + n] = (uint16_t)value;
    else ((unsigned char *)values)[y * count + n] = (unsigned char)value;
  }
}

/* Restarts stand at the ends of rows (T.81, H.1.1). */
static hl_status take_rows(decoder *d, uint16_t *rows, void *values, hl_error *error) {
  size_t count = d->columns * d->components, since = 0;
  if (d->restart % d->columns != 0) return refuse(d, "a restart within a row", error);
  for (size_t y = 0; y < d->rows; y++) {
    if (d->restart > 0 && since == d->restart) {
      take_restart(d);
      since = 0;
    }
    uint16_t *row = rows + y % 2 * count;
    const uint16_t *above = since == 0 ? NULL : rows + (y + 1) % 2 * count;
    if (!take_row(d, above, row)) return refuse(d, "its codes are damaged", error);
    if (d->missing > 64) return refuse(d, "it ends before its last pixel", error);
    store_row(d, row, y, values);
    since += d->columns;
  }
  return HL_OK;
}

hl_status hl_dicom_decode_jpeg_lossless(const hl_dicom_packed *packed, void *values, hl_error *error) {
  decoder *d = hl_allocate_zeroed(packed->context, 1, sizeof *d);
  if (d == NULL) return hl_fail_memory(error, sizeof *d, packed->path);
  d->packed = packed;
  d->bytes = packed->bytes;
  d->length = packed->length;
  uint16_t *rows = NULL;
  hl_status status = read_headers(d, error);
  if (status == HL_OK) {
    size_t count = 2 * d->columns * d->components;
    rows = hl_allocate_zeroed(packed->context, count, sizeof *rows);
    status = rows == NULL ? hl_fail_memory(error, count * sizeof *rows, packed->path)
                          : take_rows(d, rows, values, error);
  }
  hl_release(packed->context, rows);
  hl_release(packed->context, d);
  return status;
}
