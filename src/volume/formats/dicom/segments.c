/* volume/formats/dicom/segments.c - reads the numbers, names and colours of the segments that a segmentation
 * object lists. */
#include "volume/formats/dicom/segments.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "elementary/elementary.h"
#include "volume/io/text.h"

enum {
  SEGMENTATION_TYPE = 0x00620001,
  FRACTION_MOST = 0x0062000e,
  NUMBER = 0x00620004,
  LABEL = 0x00620005,
  COLOR = 0x0062000d
};
enum {
  HL_NO_SEGMENT = -1 /* stands for the missing number of a segment whose item states no number; no frame
                      * refers to a segment without a number */
};

size_t hl_dicom_segment_of(const hl_dicom_segments *segments, double number) {
  for (size_t n = 0; n < segments->count; n++)
    if ((double)segments->list[n].value == number) return n;
  return SIZE_MAX;
}

static hl_status take_kind(hl_dicom_reader *reader, const hl_dicom_element *element,
                           hl_dicom_segments *segments, hl_error *error) {
  static const char *const names[] = {
      [HL_DICOM_BINARY] = "BINARY", [HL_DICOM_FRACTIONAL] = "FRACTIONAL", [HL_DICOM_LABEL_MAP] = "LABELMAP"};
  char text[32];
  hl_status status = hl_dicom_text(reader, element, text, sizeof text, error);
  for (int kind = HL_DICOM_BINARY; status == HL_OK && kind <= HL_DICOM_LABEL_MAP; kind++)
    if (hl_text_equal(text, names[kind])) segments->kind = (hl_dicom_segment_kind)kind;
  return status;
}

/* Finds the segment that the current item describes. For a new item, adds an empty segment. */
static hl_status segment_of_item(const hl_dicom_reader *reader, hl_dicom_segments *segments,
                                 hl_segment **segment, hl_error *error) {
  size_t index = reader->level[0].item;
  if (index >= HL_MOST_SEGMENTS)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: more than %d segments: export some of them alone",
                   hl_source_path(reader->source), HL_MOST_SEGMENTS);
  if (index >= segments->capacity) {
    size_t capacity = 2 * (index + 8);
    hl_segment *larger = hl_reallocate(hl_source_context(reader->source), segments->list, capacity,
                                       sizeof *larger);
    if (larger == NULL) return hl_fail_memory(error, capacity * sizeof *larger, "a list of segments");
    segments->list = larger;
    segments->capacity = capacity;
  }
  while (segments->count <= index) segments->list[segments->count++] = (hl_segment){.value = HL_NO_SEGMENT};
  *segment = &segments->list[index];
  return HL_OK;
}

static double cube_or_line(double t) {
  const double delta = 6.0 / 29;
  return t > delta ? t * t * t : 3 * delta * delta * (t - 4.0 / 29);
}

static double encode_srgb(double linear) { /* the transfer curve of sRGB, IEC 61966-2-1 */
  double code = linear <= 0.0031308 ? 12.92 * linear : 1.055 * hl_pow(linear, 1 / 2.4) - 0.055;
  return code <= 0 ? 0 : code >= 1 ? 1 : code;
}

/* Converts CIELab with the white point D50 to sRGB. Codes from 0 to 65535 stand for L* from 0 to 100, and for
 * a* and b* from -128 to 127 (PS3.3, C.10.7.1.1). The matrix is the matrix of sRGB, adapted from D65 to D50
 * by Bradford's method (ICC, sRGB profile). */
static void to_srgb(const double codes[3], double srgb[3]) {
  static const double white[3] = {0.9642, 1, 0.8249};
  static const double matrix[3][3] = {{3.1338561, -1.6168667, -0.4906146},
                                      {-0.9787684, 1.9161415, 0.0334540},
                                      {0.0719453, -0.2289914, 1.4052427}};
  double lightness = codes[0] / 65535 * 100, a = codes[1] / 65535 * 255 - 128,
         b = codes[2] / 65535 * 255 - 128;
  double middle = (lightness + 16) / 116;
  const double xyz[3] = {white[0] * cube_or_line(middle + a / 500), white[1] * cube_or_line(middle),
                         white[2] * cube_or_line(middle - b / 200)};
  for (int c = 0; c < 3; c++)
    srgb[c] = encode_srgb(matrix[c][0] * xyz[0] + matrix[c][1] * xyz[1] + matrix[c][2] * xyz[2]);
}

static hl_status take_of_segment(hl_dicom_reader *reader, const hl_dicom_element *element,
                                 hl_dicom_segments *segments, hl_error *error) {
  hl_segment *segment = NULL;
  double numbers[3];
  int count;
  hl_status status = segment_of_item(reader, segments, &segment, error);
  if (status != HL_OK) return status;
  if (element->tag == LABEL)
    return hl_dicom_text(reader, element, segment->name, sizeof segment->name, error);
  status = hl_dicom_numbers(reader, element, HL_DICOM_VR('U', 'S'), numbers, element->tag == COLOR ? 3 : 1,
                            &count, error);
  if (status == HL_OK && element->tag == NUMBER && count == 1) segment->value = (int64_t)numbers[0];
  if (status == HL_OK && element->tag == COLOR && count == 3) {
    to_srgb(numbers, segment->srgb);
    segment->has_color = true;
  }
  return status;
}

hl_status hl_dicom_segments_take(hl_dicom_reader *reader, const hl_dicom_element *element,
                                 hl_dicom_segments *segments, hl_error *error) {
  uint32_t tag = element->tag;
  int count;
  if (reader->depth == 0 && tag == SEGMENTATION_TYPE) return take_kind(reader, element, segments, error);
  if (reader->depth == 0 && tag == FRACTION_MOST)
    return hl_dicom_numbers(reader, element, HL_DICOM_VR('U', 'S'), &segments->fraction_most, 1, &count,
                            error);
  if (reader->depth == 1 && reader->level[0].tag == HL_DICOM_SEGMENTS &&
      (tag == NUMBER || tag == LABEL || tag == COLOR))
    return take_of_segment(reader, element, segments, error);
  return HL_OK;
}

void hl_dicom_segments_release(hl_context *context, hl_dicom_segments *segments) {
  hl_release(context, segments->list);
  segments->list = NULL;
  segments->count = segments->capacity = 0;
}
