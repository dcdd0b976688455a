/* volume/formats/dicom/jpeg_codes.c - reads JPEG's marker segments and Huffman codes. */
#include "volume/formats/dicom/jpeg_codes.h"

#include <string.h>

/* Reads the next marker segment, and sets *marker and *content to the segment's marker and content. Returns
 * false at the end of the data, or if no segment begins at the read position. */
static bool next_segment(hl_jpeg_reader *r, int *marker, const unsigned char **content, size_t *length) {
  while (r->at + 4 <= r->length && r->bytes[r->at] == 0xff && r->bytes[r->at + 1] == 0xff) r->at++;
  if (r->at + 4 > r->length || r->bytes[r->at] != 0xff) return false;
  size_t told = (size_t)r->bytes[r->at + 2] << 8 | r->bytes[r->at + 3];
  if (told < 2 || told > r->length - r->at - 2) return false;
  *marker = r->bytes[r->at + 1];
  *content = r->bytes + r->at + 4;
  *length = told - 2;
  r->at += 2 + told;
  return true;
}

/* Makes the codes of a table from the number of codes of each length. Codes of the same length are
 * consecutive numbers (T.81, figures C.1 and C.2). */
static void make_codes(hl_jpeg_table *table, const unsigned char *counts) {
  int code = 0, index = 0;
  memset(table->look, 0, sizeof table->look);
  for (int length = 1; length <= 16; length++) {
    table->first[length] = code - index;
    for (int n = 0; n < counts[length - 1]; n++, code++, index++)
      for (int tail = 0; length <= HL_JPEG_LOOK_BITS && tail < 1 << (HL_JPEG_LOOK_BITS - length); tail++) {
        int place = code << (HL_JPEG_LOOK_BITS - length) | tail;
        if (place < 1 << HL_JPEG_LOOK_BITS)
          table->look[place] = (uint16_t)(length << 8 | table->values[index]);
      }
    table->greatest[length] = counts[length - 1] > 0 ? code - 1 : -1;
    code <<= 1;
  }
  table->known = true;
}

/* Reads the Huffman tables of a segment. Returns false if one of the tables is damaged. */
static bool take_tables(hl_jpeg_reader *r, const unsigned char *bytes, size_t length) {
  while (length >= 17) {
    size_t count = 0;
    for (int n = 1; n <= 16; n++) count += bytes[n];
    if ((bytes[0] & 15) >= HL_JPEG_TABLES || bytes[0] >> 4 > 1 || count > 256 || count > length - 17)
      return false;
    hl_jpeg_table *table = &r->table[bytes[0] >> 4][bytes[0] & 15];
    memset(table->values, 0, sizeof table->values);
    memcpy(table->values, bytes + 17, count);
    make_codes(table, bytes + 1);
    bytes += 17 + count;
    length -= 17 + count;
  }
  return true;
}

hl_status hl_jpeg_read_headers(hl_jpeg_reader *r, const hl_dicom_packed *packed, const char *name,
                               hl_jpeg_take_function *take, void *decoder, hl_error *error) {
  const unsigned char *content;
  size_t length;
  int marker = 0;
  r->bytes = packed->bytes;
  r->length = packed->length;
  r->at = 2; /* skips the marker that begins the picture */
  hl_status status = HL_OK;
  while (status == HL_OK && marker != HL_JPEG_SCAN) {
    if (!next_segment(r, &marker, &content, &length))
      return hl_dicom_fail_packed(packed, name, "it ends before its pixels", error);
    if (marker == HL_JPEG_TABLES_OF_CODES && !take_tables(r, content, length))
      return hl_dicom_fail_packed(packed, name, "a table of codes is damaged", error);
    if (marker == HL_JPEG_RESTART_INTERVAL && length >= 2) r->restart = (size_t)content[0] << 8 | content[1];
    status = take(decoder, marker, content, length, error);
  }
  return status;
}

void hl_jpeg_fill(hl_jpeg_reader *r) {
  while (r->bit_count <= 48) {
    unsigned byte = 0;
    if (r->at < r->length && r->bytes[r->at] != 0xff) byte = r->bytes[r->at++];
    else if (r->at + 1 < r->length && r->bytes[r->at + 1] == 0) {
      byte = 0xff; /* in the data of a scan, a zero byte follows each 0xff */
      r->at += 2;
    } else r->missing++;
    r->bits = r->bits << 8 | byte;
    r->bit_count += 8;
  }
}

static unsigned peek(const hl_jpeg_reader *r, int count) {
  return (unsigned)(r->bits >> (r->bit_count - count)) & ((1u << count) - 1);
}

int hl_jpeg_take_code(hl_jpeg_reader *r, const hl_jpeg_table *table) {
  unsigned look = table->look[peek(r, HL_JPEG_LOOK_BITS)];
  if (look != 0) {
    r->bit_count -= (int)(look >> 8);
    return (int)(look & 255);
  }
  for (int length = HL_JPEG_LOOK_BITS + 1; length <= 16; length++) {
    int code = (int)peek(r, length), index = code - table->first[length];
    if (table->greatest[length] < 0 || code > table->greatest[length]) continue;
    r->bit_count -= length;
    return index >= 0 && index < 256 ? table->values[index] : -1;
  }
  return -1;
}

int hl_jpeg_take_number(hl_jpeg_reader *r, int count) {
  int value = (int)peek(r, count);
  r->bit_count -= count;
  return value < 1 << (count - 1) ? value - (1 << count) + 1 : value;
}

void hl_jpeg_take_restart(hl_jpeg_reader *r) {
  r->bits = 0;
  r->bit_count = 0;
  while (r->at + 1 < r->length &&
         !(r->bytes[r->at] == 0xff && r->bytes[r->at + 1] >= 0xd0 && r->bytes[r->at + 1] <= 0xd7))
    r->at++;
  if (r->at + 1 < r->length) r->at += 2;
}
