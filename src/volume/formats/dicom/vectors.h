/* volume/formats/dicom/vectors.h - the vectors of nuclear medicine, which tell each frame's slice, time slot
 * and so on.
 *
 * Source: DICOM PS3.3, C.8.4.8 (NM multi-frame), C.7.6.6 (multi-frame). */
#ifndef HL_VOLUME_DICOM_VECTORS_H
#define HL_VOLUME_DICOM_VECTORS_H

#include "volume/formats/dicom/elements.h"

enum { HL_DICOM_VECTORS = 9 };

typedef struct hl_dicom_vector {
  uint16_t *numbers; /* owned; [count]; null if not told */
  size_t count;      /* number of frames */
} hl_dicom_vector;

typedef struct hl_dicom_vectors {
  hl_dicom_vector list[HL_DICOM_VECTORS];
  bool are_times; /* whether the frames follow each other in time, as in films of ultrasound or angiography */
} hl_dicom_vectors;

/* Takes an element at the top of a file. Elements that have nothing to do with vectors change nothing. */
hl_status hl_dicom_vectors_take(hl_dicom_reader *reader, const hl_dicom_element *element,
                                hl_dicom_vectors *vectors, hl_error *error);
void hl_dicom_vectors_release(hl_context *context, hl_dicom_vectors *vectors);

/* The frame's slice, counted from 0. Where no slices are told, the result is the frame's own index, or 0 if
 * the frames are times. */
size_t hl_dicom_vectors_slice(const hl_dicom_vectors *vectors, size_t frame);
/* A number for the volume to which a frame belongs. It differs between volumes, and rises from each volume to
 * the next. NAN if no vector tells it. */
double hl_dicom_vectors_volume(const hl_dicom_vectors *vectors, size_t frame);
/* Whether the frames are projections from several sides, not slices. */
bool hl_dicom_vectors_are_projections(const hl_dicom_vectors *vectors);

#endif
