/* volume/formats/dicom/jpeg_extended.c - decodes lossy grey JPEG of 12 bits (process 4). libjpeg reads only 8
 * bits.
 *
 * Source: ITU-T T.81. Frames and scans: annex B. Sequential coefficients: annex F.2. The inverse cosine
 * transform: A.3.3. */
#include <math.h>
#include <string.h>

#include "core/error.h"
#include "core/memory.h"
#include "volume/formats/dicom/jpeg_codes.h"

typedef struct decoder {
  const hl_dicom_packed *packed;
  hl_jpeg_reader reader;
  int precision, quantization, id; /* id: the component's number */
  const hl_jpeg_table *dc, *ac;
  size_t rows, columns;
  uint16_t steps[HL_JPEG_TABLES][64]; /* quantization steps of each table, in zigzag order; 0 for steps that
                                       * the file does not state */
} decoder;

static hl_status refuse(const decoder *d, const char *why, hl_error *error) {
  return hl_dicom_fail_packed(d->packed, "JPEG", why, error);
}

/* ---- headers ---- */

static hl_status take_steps(decoder *d, const unsigned char *bytes, size_t length, hl_error *error) {
  while (length > 0) {
    size_t wide = bytes[0] >> 4 != 0 ? 2 : 1, index = bytes[0] & 15;
    if (index >= HL_JPEG_TABLES || length < 1 + 64 * wide) return refuse(d, "its steps are damaged", error);
    for (size_t n = 0; n < 64; n++)
      d->steps[index][n] = wide == 2 ? (uint16_t)(bytes[1 + 2 * n] << 8 | bytes[2 + 2 * n]) : bytes[1 + n];
    bytes += 1 + 64 * wide;
    length -= 1 + 64 * wide;
  }
  return HL_OK;
}

static hl_status take_frame(decoder *d, const unsigned char *bytes, size_t length, hl_error *error) {
  if (length < 9) return refuse(d, "its frame header is too short", error);
  d->precision = bytes[0];
  d->rows = (size_t)bytes[1] << 8 | bytes[2];
  d->columns = (size_t)bytes[3] << 8 | bytes[4];
  d->id = bytes[6];
  d->quantization = bytes[8];
  hl_status status = hl_dicom_check_packed(d->packed, "JPEG", d->columns, d->rows, bytes[5], d->precision,
                                           error);
  if (status == HL_OK && (bytes[5] != 1 || d->precision != 12 || d->quantization >= HL_JPEG_TABLES))
    status = hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "%s: its pixels are lossy JPEG of %d components of %d bits: 1 of 12 bits is read, or 8 "
                     "bits: decompress it with dcmdjpeg",
                     d->packed->path, bytes[5], d->precision);
  return status;
}

static hl_status take_scan(decoder *d, const unsigned char *bytes, size_t length, hl_error *error) {
  if (d->rows == 0) return refuse(d, "a scan comes before the frame header", error);
  if (length < 6 || bytes[0] != 1 || bytes[1] != d->id) return refuse(d, "its scan has no component", error);
  int dc = bytes[2] >> 4, ac = bytes[2] & 15;
  if (dc >= HL_JPEG_TABLES || ac >= HL_JPEG_TABLES || !d->reader.table[0][dc].known ||
      !d->reader.table[1][ac].known)
    return refuse(d, "its component has no table of codes", error);
  d->dc = &d->reader.table[0][dc];
  d->ac = &d->reader.table[1][ac];
  return HL_OK;
}

static hl_status take(void *decoder_, int marker, const unsigned char *content, size_t length,
                      hl_error *error) {
  decoder *d = decoder_;
  if (marker == HL_JPEG_QUANTIZATION) return take_steps(d, content, length, error);
  if (marker == HL_JPEG_FRAME || marker == HL_JPEG_FRAME_EXTENDED)
    return take_frame(d, content, length, error);
  return marker == HL_JPEG_SCAN ? take_scan(d, content, length, error) : HL_OK;
}

/* ---- blocks of 8 x 8 ---- */

/* The zigzag order: for each coefficient, its position in a block, which is row times 8 plus column (T.81,
 * figure A.6). */
static const unsigned char zigzag[64] = {0,  1,  8,  16, 9,  2,  3,  10, 17, 24, 32, 25, 18, 11, 4,  5,
                                         12, 19, 26, 33, 40, 48, 41, 34, 27, 20, 13, 6,  7,  14, 21, 28,
                                         35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23, 30, 37, 44, 51,
                                         58, 59, 52, 45, 38, 31, 39, 46, 53, 60, 61, 54, 47, 55, 62, 63};

/* Decodes the coefficients of a block, and multiplies them by their quantization steps. Returns false if the
 * codes are damaged. */
static bool take_block(decoder *d, int *previous, double block[64]) {
  hl_jpeg_reader *r = &d->reader;
  const uint16_t *steps = d->steps[d->quantization];
  memset(block, 0, 64 * sizeof *block);
  hl_jpeg_fill(r);
  int category = hl_jpeg_take_code(r, d->dc);
  if (category < 0 || category > 15) return false;
  if (category > 0) *previous += hl_jpeg_take_number(r, category);
  if (*previous < -(1 << 20) || *previous > 1 << 20) return false;
  block[0] = (double)*previous * steps[0];
  for (int n = 1; n < 64; n++) {
    if (r->bit_count < 32) hl_jpeg_fill(r);
    int code = hl_jpeg_take_code(r, d->ac), size = code & 15, run = code >> 4;
    if (code < 0) return false;
    if (size == 0 && run < 15) break; /* the other coefficients are zeros */
    n += run;
    if (n > 63) return false;
    if (size > 0) block[zigzag[n]] = (double)hl_jpeg_take_number(r, size) * steps[n];
  }
  return true;
}

/* cosines[n] is cos(n pi / 16) / 2 for n from 0 to 7; cosines[0] is also divided by the square root of 2. */
static const double cosines[8] = {0.35355339059327376220, 0.49039264020161522456, 0.46193976625564337806,
                                  0.41573480615127261854, 0.35355339059327376220, 0.27778511650980111237,
                                  0.19134171618254488586, 0.09754516100806413392};

/* The factor C(u) / 2 cos((2 x + 1) u pi / 16), by which the inverse transform multiplies coefficient u for
 * sample x. */
static double factor(int x, int u) {
  int turn = (2 * x + 1) * u % 32; /* the angle, of which 32 units are a full turn; for u from 1 to 7 the
                                    * angle is neither 0 nor 16 */
  if (u == 0) return cosines[0];
  if (turn > 16) turn = 32 - turn;
  if (turn == 8) return 0;
  return turn < 8 ? cosines[turn] : -cosines[16 - turn];
}

/* Applies the inverse cosine transform, first along rows, then along columns (T.81, A.3.3). */
static void transform(const double factors[8][8], double block[64]) {
  double rows[64];
  for (int v = 0; v < 8; v++)
    for (int x = 0; x < 8; x++) {
      double sum = 0;
      for (int u = 0; u < 8; u++) sum += factors[x][u] * block[8 * v + u];
      rows[8 * v + x] = sum;
    }
  for (int y = 0; y < 8; y++)
    for (int x = 0; x < 8; x++) {
      double sum = 0;
      for (int v = 0; v < 8; v++) sum += factors[y][v] * rows[8 * v + x];
      block[8 * y + x] = sum;
    }
}

static void store_block(const decoder *d, size_t left, size_t top, const double block[64], uint16_t *values) {
  const double middle = 1 << (d->precision - 1), most = (1 << d->precision) - 1;
  for (size_t y = 0; y < 8 && top + y < d->rows; y++)
    for (size_t x = 0; x < 8 && left + x < d->columns; x++) {
      double value = floor(block[8 * y + x] + middle + 0.5);
      values[(top + y) * d->columns + left + x] = (uint16_t)(value < 0 ? 0 : value > most ? most : value);
    }
}

static hl_status take_blocks(decoder *d, uint16_t *values, hl_error *error) {
  double factors[8][8], block[64];
  for (int x = 0; x < 8; x++)
    for (int u = 0; u < 8; u++) factors[x][u] = factor(x, u);
  size_t done = 0;
  int previous = 0;
  for (size_t top = 0; top < d->rows; top += 8)
    for (size_t left = 0; left < d->columns; left += 8, done++) {
      if (d->reader.restart > 0 && done > 0 && done % d->reader.restart == 0) {
        hl_jpeg_take_restart(&d->reader);
        previous = 0;
      }
      if (!take_block(d, &previous, block)) return refuse(d, "its codes are damaged", error);
      if (d->reader.missing > 64) return refuse(d, "it ends before its last pixel", error);
      transform(factors, block);
      store_block(d, left, top, block, values);
    }
  return HL_OK;
}

hl_status hl_dicom_decode_jpeg_extended(const hl_dicom_packed *packed, void *values, hl_error *error) {
  decoder *d = hl_allocate_zeroed(packed->context, 1, sizeof *d);
  if (d == NULL) return hl_fail_memory(error, sizeof *d, packed->path);
  d->packed = packed;
  hl_status status = hl_jpeg_read_headers(&d->reader, packed, "JPEG", take, d, error);
  if (status == HL_OK) status = take_blocks(d, values, error);
  hl_release(packed->context, d);
  return status;
}
