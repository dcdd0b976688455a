/* volume/formats/dicom/mosaic.c - finds the number of slices of a mosaic and their normal, as mosaic.h
 * describes. */
#include "volume/formats/dicom/mosaic.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "volume/io/text.h"

/* The greatest CSA header that is read, in bytes. The CSA headers that scanners write have about 12 KiB. */
enum { CSA_BYTES_MOST = 1 << 20, CSA_TAGS_MOST = 1024, CSA_ITEMS_MOST = 1 << 16, NAME_BYTES = 64 };

/* A CSA header that is read byte after byte. */
typedef struct csa_reader {
  const unsigned char *bytes;
  size_t length, at;
} csa_reader;

/* Reads a number of four bytes; 0 beyond the end of the CSA header. */
static uint32_t next_word(csa_reader *csa) {
  if (csa->length - csa->at < 4) {
    csa->at = csa->length;
    return 0;
  }
  csa->at += 4;
  return hl_dicom_u32(csa->bytes + csa->at - 4, false);
}

static void pass(csa_reader *csa, size_t count) {
  csa->at = count < csa->length - csa->at ? csa->at + count : csa->length;
}

/* Converts a text to a number. */
static double number_of(const unsigned char *bytes, size_t length) {
  char text[64];
  double number;
  if (length >= sizeof text) length = sizeof text - 1;
  memcpy(text, bytes, length);
  text[length] = 0;
  char *trimmed = hl_text_trim(text);
  return hl_text_number(trimmed, strlen(trimmed), &number) ? number : 0;
}

/* Reads the numbers of a tag, which has `items` items. An item consists of four words and a text. One of the
 * words is the length of the text, which is padded to whole words. The text of an item is a decimal number.
 * numbers: [most]; set to the numbers of the first items. */
static void read_items(csa_reader *csa, bool second, uint32_t items, double *numbers, uint32_t most) {
  for (uint32_t n = 0; n < items && csa->at < csa->length; n++) {
    uint32_t words[4];
    for (int w = 0; w < 4; w++) words[w] = next_word(csa);
    size_t length = second ? words[1] : words[0], left = csa->length - csa->at;
    if (length > left) length = left;
    if (n < most && length > 0) numbers[n] = number_of(csa->bytes + csa->at, length);
    pass(csa, length + (4 - length % 4) % 4);
  }
}

/* Searches a CSA header for the number of slices and for their normal. CSA headers are of two kinds; a header
 * of the second kind begins with "SV10". */
static void read_csa(csa_reader *csa, hl_dicom_mosaic *mosaic) {
  bool second = csa->length >= 4 && memcmp(csa->bytes, "SV10", 4) == 0;
  if (second) csa->at = 8;
  uint32_t tags = next_word(csa);
  next_word(csa);
  for (uint32_t t = 0; t < tags && t < CSA_TAGS_MOST && csa->length - csa->at > NAME_BYTES; t++) {
    const char *name = (const char *)csa->bytes + csa->at;
    pass(csa, NAME_BYTES + 4 + 4 + 4); /* skips the tag's name, number of values, and type, which is stated
                                        * twice */
    uint32_t items = next_word(csa);
    next_word(csa);
    if (items > CSA_ITEMS_MOST) return;
    double numbers[3] = {0, 0, 0};
    bool of_slices = strncmp(name, "NumberOfImagesInMosaic", NAME_BYTES) == 0;
    bool of_normal = strncmp(name, "SliceNormalVector", NAME_BYTES) == 0;
    read_items(csa, second, items, numbers, 3);
    if (of_slices && mosaic->slices == 0) mosaic->slices = numbers[0];
    if (of_normal) memcpy(mosaic->normal, numbers, sizeof numbers);
  }
}

static hl_status take_csa(hl_dicom_reader *reader, const hl_dicom_element *element, hl_dicom_mosaic *mosaic,
                          hl_error *error) {
  hl_context *context = hl_source_context(reader->source);
  if (element->length > CSA_BYTES_MOST) return HL_OK;
  unsigned char *bytes = hl_allocate(context, element->length + 1, 1);
  if (bytes == NULL) return hl_fail_memory(error, element->length, "a private header");
  csa_reader csa = {.bytes = bytes};
  hl_status status = hl_source_read(reader->source, element->offset, bytes, element->length, &csa.length,
                                    error);
  if (status == HL_OK) read_csa(&csa, mosaic);
  hl_release(context, bytes);
  return status;
}

/* Reads a private creator, which is an element that reserves a block of elements for the name in its value.
 * If the value is `name`, *block becomes the block's number; otherwise it is not changed. */
static hl_status take_creator(hl_dicom_reader *reader, const hl_dicom_element *element, const char *name,
                              unsigned *block, hl_error *error) {
  char text[64];
  hl_status status = hl_dicom_text(reader, element, text, sizeof text, error);
  if (status == HL_OK && strcmp(text, name) == 0) *block = element->tag & 0xff;
  return status;
}

hl_status hl_dicom_mosaic_take(hl_dicom_reader *reader, const hl_dicom_element *element,
                               hl_dicom_mosaic *mosaic, hl_error *error) {
  uint32_t group = element->tag >> 16, number = element->tag & 0xffff;
  if (reader->depth > 0 || (group != 0x0019 && group != 0x0029)) return HL_OK;
  if (number >= 0x10 && number <= 0xff)
    return group == 0x0019 ? take_creator(reader, element, "SIEMENS MR HEADER", &mosaic->header_block, error)
                           : take_creator(reader, element, "SIEMENS CSA HEADER", &mosaic->csa_block, error);
  int count;
  if (group == 0x0019 && mosaic->header_block != 0 && number == (mosaic->header_block << 8 | 0x0a))
    return hl_dicom_numbers(reader, element, HL_DICOM_VR('U', 'S'), &mosaic->slices, 1, &count, error);
  if (group == 0x0029 && mosaic->csa_block != 0 && number == (mosaic->csa_block << 8 | 0x10))
    return take_csa(reader, element, mosaic, error);
  return HL_OK;
}
