/* volume/formats/dicom/vectors.c - reads the vectors of nuclear medicine, which state for example the slice
 * and the time slot of each frame. */
#include "volume/formats/dicom/vectors.h"

#include <math.h>

#include "core/memory.h"

enum { SLICES = 6, ROTATIONS = 3, ANGLES = 7, BYTES_MOST = 1 << 21 };

/* The tags of the vectors, the vector that is most significant for the order of volumes first: energy
 * windows, detectors, phases, rotations, R-R intervals, time slots, slices, angular views, time slices. */
static const uint32_t tags[HL_DICOM_VECTORS] = {0x00540010, 0x00540020, 0x00540030, 0x00540050, 0x00540060,
                                                0x00540070, 0x00540080, 0x00540090, 0x00540100};

static hl_status take_vector(hl_dicom_reader *reader, const hl_dicom_element *element,
                             hl_dicom_vector *vector, hl_error *error) {
  hl_context *context = hl_source_context(reader->source);
  if (vector->numbers != NULL || element->length > BYTES_MOST || element->length < 2) return HL_OK;
  unsigned char *bytes = hl_allocate(context, element->length, 1);
  vector->numbers = hl_allocate(context, element->length / 2, sizeof *vector->numbers);
  if (bytes == NULL || vector->numbers == NULL) {
    hl_release(context, bytes);
    return hl_fail_memory(error, 2 * (size_t)element->length, "a vector of frames");
  }
  size_t length;
  hl_status status = hl_source_read(reader->source, element->offset, bytes, element->length, &length, error);
  for (; status == HL_OK && 2 * vector->count + 1 < length; vector->count++)
    vector->numbers[vector->count] = (uint16_t)hl_dicom_u16(bytes + 2 * vector->count, reader->big_endian);
  hl_release(context, bytes);
  return status;
}

/* Reads the Frame Increment Pointer (0028,0009), which names the attribute by which frames differ. If this
 * attribute is the Frame Time (0018,1063) or the Frame Time Vector (0018,1065), the frames are times. */
static hl_status take_increment(hl_dicom_reader *reader, const hl_dicom_element *element,
                                hl_dicom_vectors *vectors, hl_error *error) {
  unsigned char bytes[4];
  size_t length;
  if (element->length != sizeof bytes) return HL_OK;
  hl_status status = hl_source_read(reader->source, element->offset, bytes, sizeof bytes, &length, error);
  if (status != HL_OK || length != sizeof bytes) return status;
  uint32_t tag = (uint32_t)hl_dicom_u16(bytes, reader->big_endian) << 16 |
                 (uint32_t)hl_dicom_u16(bytes + 2, reader->big_endian);
  vectors->are_times = tag == 0x00181063 || tag == 0x00181065;
  return HL_OK;
}

hl_status hl_dicom_vectors_take(hl_dicom_reader *reader, const hl_dicom_element *element,
                                hl_dicom_vectors *vectors, hl_error *error) {
  if (element->tag == 0x00280009 && reader->depth == 0)
    return take_increment(reader, element, vectors, error);
  for (int n = 0; n < HL_DICOM_VECTORS && reader->depth == 0; n++)
    if (element->tag == tags[n]) return take_vector(reader, element, &vectors->list[n], error);
  return HL_OK;
}

size_t hl_dicom_vectors_slice(const hl_dicom_vectors *vectors, size_t frame) {
  const hl_dicom_vector *slices = &vectors->list[SLICES];
  if (frame >= slices->count) return vectors->are_times ? 0 : frame;
  return slices->numbers[frame] > 0 ? slices->numbers[frame] - 1u : 0;
}

double hl_dicom_vectors_volume(const hl_dicom_vectors *vectors, size_t frame) {
  double number = vectors->are_times ? (double)frame : NAN;
  for (int n = 0; n < HL_DICOM_VECTORS && vectors->list[SLICES].numbers != NULL; n++) {
    const hl_dicom_vector *vector = &vectors->list[n];
    if (n == SLICES || frame >= vector->count) continue;
    number = (isnan(number) ? 0 : 1024 * number) + vector->numbers[frame];
  }
  return number;
}

bool hl_dicom_vectors_are_projections(const hl_dicom_vectors *vectors) {
  return vectors->list[SLICES].numbers == NULL &&
         (vectors->list[ROTATIONS].count > 1 || vectors->list[ANGLES].count > 1);
}

void hl_dicom_vectors_release(hl_context *context, hl_dicom_vectors *vectors) {
  for (int n = 0; n < HL_DICOM_VECTORS; n++) {
    hl_release(context, vectors->list[n].numbers);
    vectors->list[n].numbers = NULL;
  }
}
