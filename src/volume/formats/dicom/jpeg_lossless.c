/* volume/formats/dicom/jpeg_lossless.c - decodes lossless JPEG with Huffman codes, process 14, which no
 * library in Debian reads.
 *
 * Source: ITU-T T.81, annex H. */
#include "core/error.h"
#include "core/memory.h"
#include "volume/formats/dicom/jpeg_codes.h"

enum { COMPONENTS_MOST = 3 };

typedef struct component {
  int id, table;
} component;

typedef struct decoder {
  const hl_dicom_packed *packed;
  hl_jpeg_reader reader;
  int precision, predictor, shift; /* shift: the point transform */
  size_t rows, columns, components;
  component component[COMPONENTS_MOST];
} decoder;

static hl_status refuse(const decoder *d, const char *why, hl_error *error) {
  return hl_dicom_fail_packed(d->packed, "lossless JPEG", why, error);
}

/* ---- headers ---- */

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
    if (bytes[1 + 2 * c] != d->component[c].id || d->component[c].table >= HL_JPEG_TABLES ||
        !d->reader.table[0][d->component[c].table].known)
      return refuse(d, "a component has no table of codes", error);
  }
  const unsigned char *rest = bytes + 1 + 2 * d->components;
  d->predictor = rest[0];
  d->shift = rest[2] & 15;
  if (d->predictor < 1 || d->predictor > 7 || d->shift >= d->precision)
    return refuse(d, "its predictor is not one of 1 to 7", error);
  return HL_OK;
}

static hl_status take(void *decoder_, int marker, const unsigned char *content, size_t length,
                      hl_error *error) {
  decoder *d = decoder_;
  if (marker == HL_JPEG_FRAME_LOSSLESS) return take_frame(d, content, length, error);
  return marker == HL_JPEG_SCAN ? take_scan(d, content, length, error) : HL_OK;
}

/* ---- samples ---- */

/* Decodes the next difference between a sample and its prediction (T.81, table H.2). Returns false if the
 * codes are damaged. */
static bool take_difference(hl_jpeg_reader *r, const hl_jpeg_table *table, int *difference) {
  if (r->bit_count < 32) hl_jpeg_fill(r);
  int category = hl_jpeg_take_code(r, table);
  if (category < 0 || category > 16) return false;
  *difference = category == 16 ? 32768 : category == 0 ? 0 : hl_jpeg_take_number(r, category);
  return true;
}

/* Predicts a sample (T.81, table H.1) from its neighbours. a: to the left. b: above. c: above on the left. */
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

/* Decodes a row of pixels with `step` samples each. above: the row above; null if this is the first row after
 * a restart. */
static bool take_row(decoder *d, const uint16_t *above, uint16_t *row) {
  size_t step = d->components;
  for (size_t x = 0; x < d->columns; x++)
    for (size_t c = 0; c < step; c++) {
      size_t n = x * step + c;
      int difference, expected;
      if (!take_difference(&d->reader, &d->reader.table[0][d->component[c].table], &difference)) return false;
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

/* Decodes all rows of the picture. Restart markers stand only at the ends of rows (T.81, H.1.1). */
static hl_status take_rows(decoder *d, uint16_t *rows, void *values, hl_error *error) {
  size_t count = d->columns * d->components, since = 0;
  if (d->reader.restart % d->columns != 0) return refuse(d, "a restart within a row", error);
  for (size_t y = 0; y < d->rows; y++) {
    if (d->reader.restart > 0 && since == d->reader.restart) {
      hl_jpeg_take_restart(&d->reader);
      since = 0;
    }
    uint16_t *row = rows + y % 2 * count;
    const uint16_t *above = since == 0 ? NULL : rows + (y + 1) % 2 * count;
    if (!take_row(d, above, row)) return refuse(d, "its codes are damaged", error);
    if (d->reader.missing > 64) return refuse(d, "it ends before its last pixel", error);
    store_row(d, row, y, values);
    since += d->columns;
  }
  return HL_OK;
}

hl_status hl_dicom_decode_jpeg_lossless(const hl_dicom_packed *packed, void *values, hl_error *error) {
  decoder *d = hl_allocate_zeroed(packed->context, 1, sizeof *d);
  if (d == NULL) return hl_fail_memory(error, sizeof *d, packed->path);
  d->packed = packed;
  uint16_t *rows = NULL;
  hl_status status = hl_jpeg_read_headers(&d->reader, packed, "lossless JPEG", take, d, error);
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
