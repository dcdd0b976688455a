/* volume/formats/dicom/elements.c - reads tags, value representations, sequences and items, in either byte
 * order.
 */
#include "volume/formats/dicom/elements.h"

#include <stdio.h>
#include <string.h>

#include "text/json_value.h"
#include "volume/io/text.h"

enum { MOST_TEXT_BYTES = 4096 /* the longest text that is converted */ };
enum { ITEM = 0xfffee000, ITEM_END = 0xfffee00d, SEQUENCE_END = 0xfffee0dd };

uint32_t hl_dicom_u16(const unsigned char *bytes, bool big_endian) {
  return big_endian ? (uint32_t)bytes[0] << 8 | bytes[1] : bytes[0] | (uint32_t)bytes[1] << 8;
}

uint32_t hl_dicom_u32(const unsigned char *bytes, bool big_endian) {
  uint32_t first = hl_dicom_u16(bytes, big_endian), second = hl_dicom_u16(bytes + 2, big_endian);
  return big_endian ? first << 16 | second : first | second << 16;
}

static hl_status fail_at(const hl_dicom_reader *reader, const char *what, hl_error *error) {
  return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)reader->at, "%s, byte %llu: %s",
                        hl_source_path(reader->source), (unsigned long long)reader->at, what);
}

static bool is_vr(const unsigned char *letters) {
  return letters[0] >= 'A' && letters[0] <= 'Z' && letters[1] >= 'A' && letters[1] <= 'Z';
}

/* Returns whether elements of a value representation (VR) have two reserved bytes and a length of four bytes
 * (PS3.5, table 7.1-1). */
static bool is_long(uint16_t vr) {
  static const char names[] = "OBODOFOLOVOWSQSVUCUNURUTUV";
  for (size_t n = 0; n + 1 < sizeof names; n += 2)
    if (vr == HL_DICOM_VR(names[n], names[n + 1])) return true;
  return false;
}

/* Returns whether an element is a sequence whose items are read. In files without value representations,
 * nothing marks a sequence whose length is stated. Therefore is_wanted_sequence() lists the tags of all
 * sequences that readers need. */
static bool is_wanted_sequence(uint32_t tag) {
  static const uint32_t tags[] = {
      0x52009229, 0x52009230, /* functional groups: shared, per frame */
      0x00209113, 0x00209116, /* plane position, plane orientation */
      0x00289110, 0x00289145, /* pixel measures, pixel value transformation */
      0x00209111, 0x00189114, 0x00189117,
      0x00189118, /* these sequences are frame content, MR echo, MR diffusion and cardiac synchronization */
      0x00289132, 0x00540022, 0x00041220,
      0x0062000a, /* VOI LUT of a frame, detectors, entries of a DICOMDIR, segment of a frame */
      0x0020930e, 0x0020930f, 0x00209310,
      0x00620002,                        /* plane position and orientation in an ultrasound volume,
                                          * temporal position, segments */
      0x00189076, 0x00189226, 0x00189115 /* diffusion directions, MR image frame type, MR modifier */
  };
  for (size_t n = 0; n < sizeof tags / sizeof *tags; n++)
    if (tags[n] == tag) return true;
  return false;
}

static uint64_t limited(uint64_t at, uint32_t length, uint64_t most) {
  return length == HL_DICOM_UNDEFINED || at + length > most ? most : at + length;
}

/* The position of the end of the innermost sequence or item that is being read. */
static uint64_t end_of_item(const hl_dicom_reader *reader) {
  uint64_t end = UINT64_MAX;
  for (int n = 0; n < reader->depth; n++) {
    if (reader->level[n].end < end) end = reader->level[n].end;
    if (reader->level[n].in_item && reader->level[n].item_end < end) end = reader->level[n].item_end;
  }
  return end;
}

static hl_status enter(hl_dicom_reader *reader, const hl_dicom_element *element, hl_error *error) {
  if (reader->depth == HL_DICOM_DEPTH_MOST)
    return fail_at(reader, "sequences within sequences, more than 16 deep", error);
  bool outer = reader->depth > 0 ? reader->level[reader->depth - 1].implicit : reader->implicit;
  uint64_t most = end_of_item(reader);
  reader->level[reader->depth++] = (hl_dicom_level){
      .tag = element->tag,
      .item = UINT32_MAX,
      .fragments = element->tag == HL_DICOM_PIXEL_DATA,
      /* PS3.5, 6.2.2: the elements of a sequence of unknown representation state no representations, and are
       * little-endian */
      .implicit = outer || element->vr == HL_DICOM_VR('U', 'N'),
      .end = limited(element->offset, element->length, most)};
  reader->at = element->offset;
  return HL_OK;
}

/* Reads a tag and a length that begin an item, end an item, or end a sequence. */
static hl_status take_item(hl_dicom_reader *reader, bool *ended, hl_error *error) {
  const unsigned char *bytes;
  size_t available;
  hl_dicom_level *level = &reader->level[reader->depth - 1];
  hl_status status = hl_source_peek(reader->source, reader->at, 8, &bytes, &available, error);
  if (status != HL_OK) return status;
  *ended = available < 8;
  if (*ended) return HL_OK;
  uint32_t tag = hl_dicom_u16(bytes, reader->big_endian) << 16 | hl_dicom_u16(bytes + 2, reader->big_endian);
  uint32_t length = hl_dicom_u32(bytes + 4, reader->big_endian);
  if (tag == SEQUENCE_END) reader->depth--;
  else if (tag != ITEM) return fail_at(reader, "expected an item of a sequence", error);
  reader->at += 8;
  if (tag == SEQUENCE_END) return HL_OK;
  if (level->fragments) {
    if (length == HL_DICOM_UNDEFINED) return fail_at(reader, "a fragment without a length", error);
    reader->at += length;
    return HL_OK;
  }
  level->in_item = true;
  level->item++;
  level->item_end = limited(reader->at, length, level->end);
  return HL_OK;
}

/* Leaves all items and sequences that end at the reader's position, so that an element comes next. */
static hl_status settle(hl_dicom_reader *reader, bool *ended, hl_error *error) {
  *ended = false;
  while (reader->depth > 0 && !*ended) {
    hl_dicom_level *level = &reader->level[reader->depth - 1];
    if (level->in_item && reader->at < level->item_end) return HL_OK;
    level->in_item = false;
    if (reader->at >= level->end) {
      reader->depth--;
      continue;
    }
    hl_status status = take_item(reader, ended, error);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

/* Reads an element's tag, representation and length at reader->at. *header: set to the number of bytes of
 * tag, representation and length; 0 at the end of the file. */
static hl_status take_header(hl_dicom_reader *reader, hl_dicom_element *element, size_t *header,
                             hl_error *error) {
  const unsigned char *bytes;
  size_t available;
  bool big = reader->big_endian;
  bool implicit = reader->depth > 0 ? reader->level[reader->depth - 1].implicit : reader->implicit;
  *header = 0;
  hl_status status = hl_source_peek(reader->source, reader->at, 12, &bytes, &available, error);
  if (status != HL_OK || available < 8) return status;
  *element = (hl_dicom_element){.tag = hl_dicom_u16(bytes, big) << 16 | hl_dicom_u16(bytes + 2, big)};
  *header = 8;
  element->length = hl_dicom_u32(bytes + 4, big);
  if (!implicit && element->tag >> 16 != 0xfffe && is_vr(bytes + 4)) {
    element->vr = HL_DICOM_VR(bytes[4], bytes[5]);
    element->length = hl_dicom_u16(bytes + 6, big);
    if (is_long(element->vr)) {
      *header = available < 12 ? 0 : 12;
      element->length = available < 12 ? 0 : hl_dicom_u32(bytes + 8, big);
    }
  }
  element->offset = reader->at + *header;
  return HL_OK;
}

static bool is_sequence(const hl_dicom_reader *reader, const hl_dicom_element *element) {
  if (element->tag == HL_DICOM_PIXEL_DATA) /* Pixels within a sequence belong to an icon, and are not read. */
    return reader->depth > 0 && element->length == HL_DICOM_UNDEFINED;
  return element->vr == HL_DICOM_VR('S', 'Q') || element->length == HL_DICOM_UNDEFINED ||
         (element->vr == 0 && is_wanted_sequence(element->tag));
}

hl_status hl_dicom_next(hl_dicom_reader *reader, hl_dicom_element *element, bool *found, hl_error *error) {
  *found = false;
  for (;;) {
    bool ended;
    size_t header;
    hl_status status = settle(reader, &ended, error);
    if (status != HL_OK || ended) return status;
    status = take_header(reader, element, &header, error);
    if (status != HL_OK || header == 0) return status;
    if (element->tag == ITEM_END && reader->depth > 0) {
      reader->at = element->offset;
      reader->level[reader->depth - 1].item_end = reader->at;
      continue;
    }
    if (element->tag >> 16 == 0xfffe) { /* an end marker without a beginning is ignored */
      reader->at = element->offset;
      continue;
    }
    if (is_sequence(reader, element)) {
      status = enter(reader, element, error);
      if (status != HL_OK) return status;
      continue;
    }
    *found = true;
    bool pixels = element->tag == HL_DICOM_PIXEL_DATA || element->tag == 0x7fe00008 ||
                  element->tag == 0x7fe00009;
    if (pixels && reader->depth == 0) reader->at = UINT64_MAX / 2; /* nothing after the pixels is needed */
    else if (element->length > hl_source_size(reader->source) ||
             element->offset > hl_source_size(reader->source) - element->length)
      return fail_at(reader, "the file is cut short: an element goes on beyond its end", error);
    else reader->at = element->offset + element->length;
    return HL_OK;
  }
}

static bool is_utf8(const char *text) {
  const unsigned char *c = (const unsigned char *)text;
  size_t length = 1;
  for (; *c != 0 && length > 0; c += length) length = hl_utf8_length(c);
  return length > 0;
}

/* Removes an incomplete last character from a UTF-8 text. */
static void cut_part_of_character(char *text) {
  size_t count = strlen(text), begin = count;
  while (begin > 0 && ((unsigned char)text[begin - 1] & 0xc0) == 0x80) begin--;
  if (begin > 0 && (unsigned char)text[begin - 1] >= 0xc0) begin--;
  if (begin < count && hl_utf8_length((const unsigned char *)text + begin) == 0) text[begin] = 0;
}

/* Converts a text from Latin-1 to UTF-8. Beside UTF-8, Latin-1 is the character set that is common in DICOM
 * files (PS3.3, C.12.1.1.2). If the UTF-8 text does not fit into `size` bytes, its end is cut off. */
static void convert_latin_1(char *text, size_t size) {
  char copy[MOST_TEXT_BYTES];
  size_t used = 0;
  snprintf(copy, sizeof copy, "%s", text);
  for (const char *c = copy; *c != 0 && used + 3 <= size; c++) {
    const unsigned char code = (unsigned char)*c;
    if (code < 0x80) text[used++] = *c;
    else {
      text[used++] = (char)(0xc0 | code >> 6);
      text[used++] = (char)(0x80 | (code & 0x3f));
    }
  }
  text[used] = 0;
}

hl_status hl_dicom_text(hl_dicom_reader *reader, const hl_dicom_element *element, char *text, size_t size,
                        hl_error *error) {
  const unsigned char *bytes;
  size_t available, wanted = element->length < size - 1 ? element->length : size - 1;
  hl_status status = hl_source_peek(reader->source, element->offset, wanted, &bytes, &available, error);
  if (status != HL_OK) available = 0;
  memcpy(text, bytes, available);
  text[available] = 0;
  char *trimmed = hl_text_trim(text);
  memmove(text, trimmed, strlen(trimmed) + 1);
  if (wanted < element->length) cut_part_of_character(text);
  if (!is_utf8(text)) convert_latin_1(text, size);
  return status;
}

/* Reads numbers that are written as text and separated by backslashes. Stops at a number that is empty or
 * malformed. */
static int parse_numbers(char *text, double *numbers, int most) {
  int count = 0;
  for (char *next = text; next != NULL && count < most; count++) {
    char *word = next;
    next = strchr(word, '\\');
    if (next != NULL) *next++ = 0;
    word = hl_text_trim(word);
    double number;
    if (*word == '+') word++;
    if (*word != 0 && hl_text_number(word, strlen(word), &number)) numbers[count] = number;
    else return count;
  }
  return count;
}

static size_t binary_bytes(uint16_t vr) {
  switch (vr) {
    case HL_DICOM_VR('U', 'S'):
    case HL_DICOM_VR('S', 'S'): return 2;
    case HL_DICOM_VR('U', 'L'):
    case HL_DICOM_VR('S', 'L'):
    case HL_DICOM_VR('F', 'L'): return 4;
    case HL_DICOM_VR('F', 'D'): return 8;
    default: return 0;
  }
}

static double binary_number(const unsigned char *bytes, uint16_t vr, bool big) {
  uint32_t word = hl_dicom_u16(bytes, big);
  if (vr == HL_DICOM_VR('U', 'S')) return word;
  if (vr == HL_DICOM_VR('S', 'S')) return (int16_t)word;
  word = hl_dicom_u32(bytes, big);
  if (vr == HL_DICOM_VR('U', 'L')) return word;
  if (vr == HL_DICOM_VR('S', 'L')) return (int32_t)word;
  if (vr == HL_DICOM_VR('F', 'L')) {
    float number;
    memcpy(&number, &word, sizeof number);
    return (double)number;
  }
  uint64_t other = hl_dicom_u32(bytes + 4, big);
  uint64_t wide = big ? (uint64_t)word << 32 | other : other << 32 | word;
  double number;
  memcpy(&number, &wide, sizeof number);
  return number;
}

hl_status hl_dicom_numbers(hl_dicom_reader *reader, const hl_dicom_element *element, uint16_t vr,
                           double *numbers, int most, int *count, hl_error *error) {
  char text[512];
  *count = 0;
  if (element->vr != 0 && element->vr != HL_DICOM_VR('U', 'N')) vr = element->vr;
  size_t bytes = binary_bytes(vr), available;
  if (bytes == 0) {
    hl_status status = hl_dicom_text(reader, element, text, sizeof text, error);
    if (status == HL_OK) *count = parse_numbers(text, numbers, most);
    return status;
  }
  const unsigned char *value;
  size_t wanted = element->length / bytes < (size_t)most ? element->length / bytes : (size_t)most;
  hl_status status = hl_source_peek(reader->source, element->offset, wanted * bytes, &value, &available,
                                    error);
  if (status != HL_OK) return status;
  for (*count = 0; *count < (int)(available / bytes); ++*count)
    numbers[*count] = binary_number(value + (size_t)*count * bytes, vr, reader->big_endian);
  return HL_OK;
}
