/* volume/formats/dicom/palette.c - reads the table of colours of a PALETTE COLOR picture. */
#include "volume/formats/dicom/palette.h"

#include <string.h>

#include "core/memory.h"

enum {
  RED_DESCRIPTOR = 0x00281101,
  RED_TABLE = 0x00281201,
  RED_SEGMENTED = 0x00281221,
  ENTRIES = 65536,
  BYTES_MOST = 4 * ENTRIES
};

/* The number of entries that the descriptor of red, green or blue states. */
static size_t promised(const hl_dicom_palette *palette, int c) {
  double count = palette->descriptor[c][0];
  return count > 0 && count < ENTRIES ? (size_t)count : ENTRIES;
}

/* Reads the entries of a table that is not segmented. Entries of 8 bits may lie two in a word, or one in each
 * word. Returns the number of entries that were read. */
static size_t read_plain(const unsigned char *bytes, size_t length, size_t count, int bits, bool big,
                         unsigned char *entries) {
  bool packed = bits <= 8 && length < 2 * count;
  size_t found = 0;
  for (; found < count && (packed ? found < length : 2 * found + 1 < length); found++) {
    uint32_t word = packed ? bytes[found] : hl_dicom_u16(bytes + 2 * found, big);
    entries[found] = (unsigned char)(bits > 8 ? word >> 8 : word);
  }
  return found;
}

/* The table that is filled while a segmented table is read. */
typedef struct table_writer {
  uint16_t values[ENTRIES];
  size_t count;
} table_writer;

static void add(table_writer *table, uint32_t value) {
  if (table->count < ENTRIES) table->values[table->count++] = (uint16_t)value;
}

/* Reads a segment of a table at word *at, and moves *at past it. A segment is of kind 0 (a list of values), 1
 * (a linear ramp to a value) or 2 (a repetition of earlier segments). A segment of kind 2 must not repeat a
 * segment of kind 2. */
static bool read_segment(const unsigned char *bytes, size_t words, bool big, bool nested, size_t *at,
                         table_writer *table) {
  if (*at + 2 > words) return false;
  uint32_t kind = hl_dicom_u16(bytes + 2 * *at, big), count = hl_dicom_u16(bytes + 2 * *at + 2, big);
  *at += 2;
  if (kind == 0) {
    for (; count > 0 && *at < words; count--, ++*at) add(table, hl_dicom_u16(bytes + 2 * *at, big));
    return count == 0;
  }
  if (kind == 1) {
    if (*at >= words || table->count == 0) return false;
    int32_t from = table->values[table->count - 1], to = (int32_t)hl_dicom_u16(bytes + 2 * *at, big);
    for (uint32_t n = 1; n <= count; n++)
      add(table, (uint32_t)(from + (int64_t)(to - from) * (int64_t)n / (int64_t)count));
    ++*at;
    return true;
  }
  if (kind != 2 || nested || *at + 2 > words) return false;
  size_t again = (hl_dicom_u16(bytes + 2 * *at, big) | (size_t)hl_dicom_u16(bytes + 2 * *at + 2, big) << 16) /
                 2;
  *at += 2;
  for (; count > 0; count--)
    if (!read_segment(bytes, words, big, true, &again, table)) return false;
  return true;
}

static size_t read_segmented(hl_context *context, const unsigned char *bytes, size_t length, int bits,
                             bool big, unsigned char *entries) {
  table_writer *table = hl_allocate_zeroed(context, 1, sizeof *table);
  if (table == NULL) return 0;
  size_t at = 0, words = length / 2;
  while (at < words && read_segment(bytes, words, big, false, &at, table)) {}
  for (size_t n = 0; n < table->count; n++)
    entries[n] = (unsigned char)(bits > 8 ? table->values[n] >> 8 : table->values[n]);
  size_t count = table->count;
  hl_release(context, table);
  return count;
}

static hl_status take_table(hl_dicom_reader *reader, const hl_dicom_element *element, int c, bool segmented,
                            hl_dicom_palette *palette, hl_error *error) {
  hl_context *context = hl_source_context(reader->source);
  if (element->length > BYTES_MOST || palette->entries[c] != NULL) return HL_OK;
  unsigned char *bytes = hl_allocate(context, element->length + 1, 1);
  palette->entries[c] = hl_allocate_zeroed(context, ENTRIES, 1);
  if (bytes == NULL || palette->entries[c] == NULL) {
    hl_release(context, bytes);
    return hl_fail_memory(error, element->length + ENTRIES, "a palette");
  }
  size_t length;
  int bits = palette->descriptor[c][2] > 8 ? 16 : 8;
  hl_status status = hl_source_read(reader->source, element->offset, bytes, element->length, &length, error);
  if (status == HL_OK)
    palette->counts[c] = segmented ? read_segmented(context, bytes, length, bits, reader->big_endian,
                                                    palette->entries[c])
                                   : read_plain(bytes, length, promised(palette, c), bits, reader->big_endian,
                                                palette->entries[c]);
  hl_release(context, bytes);
  return status;
}

hl_status hl_dicom_palette_take(hl_dicom_reader *reader, const hl_dicom_element *element,
                                hl_dicom_palette *palette, hl_error *error) {
  uint32_t tag = element->tag;
  int count;
  if (reader->depth > 0) return HL_OK;
  if (tag >= RED_DESCRIPTOR && tag < RED_DESCRIPTOR + 3)
    return hl_dicom_numbers(reader, element, HL_DICOM_VR('U', 'S'), palette->descriptor[tag - RED_DESCRIPTOR],
                            3, &count, error);
  if (tag >= RED_TABLE && tag < RED_TABLE + 3)
    return take_table(reader, element, (int)(tag - RED_TABLE), false, palette, error);
  if (tag >= RED_SEGMENTED && tag < RED_SEGMENTED + 3)
    return take_table(reader, element, (int)(tag - RED_SEGMENTED), true, palette, error);
  return HL_OK;
}

bool hl_dicom_palette_is_whole(const hl_dicom_palette *palette) {
  return palette->counts[0] > 0 && palette->counts[1] > 0 && palette->counts[2] > 0;
}

void hl_dicom_palette_color(const hl_dicom_palette *palette, double value, unsigned char rgb[3]) {
  for (int c = 0; c < 3; c++) {
    double at = value - palette->descriptor[c][1], last = (double)palette->counts[c] - 1;
    rgb[c] = palette->entries[c][(size_t)(at <= 0 ? 0 : at >= last ? last : at)];
  }
}

void hl_dicom_palette_release(hl_context *context, hl_dicom_palette *palette) {
  for (int c = 0; c < 3; c++) {
    hl_release(context, palette->entries[c]);
    palette->entries[c] = NULL;
  }
}
