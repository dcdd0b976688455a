/* volume/formats/dicom/vectors.h - reads the vectors of nuclear medicine, which state for example the slice
 * and the time slot of each frame.
 *
 * Source: DICOM PS3.3, C.8.4.8 (NM multi-frame), C.7.6.6 (multi-frame). */
#ifndef HL_VOLUME_DICOM_VECTORS_H
#define HL_VOLUME_DICOM_VECTORS_H

#include "volume/formats/dicom/elements.h"

enum { HL_DICOM_VECTORS = 9 };

typedef struct hl_dicom_vector {
  uint16_t *numbers; /* owned; [count]; null if the file lacks the vector */
  size_t count;      /* number of frames */
} hl_dicom_vector;

typedef struct hl_dicom_vectors {
  hl_dicom_vector list[HL_DICOM_VECTORS];
  bool are_times; /* whether the frames follow each other in time, as in films of ultrasound or angiography */
} hl_dicom_vectors;

/* Stores the facts about vectors that an element at the top level of a file states. Elements without facts
 * about vectors change nothing. */
hl_status hl_dicom_vectors_take(hl_dicom_reader *reader, const hl_dicom_element *element,
                                hl_dicom_vectors *vectors, hl_error *error);
void hl_dicom_vectors_release(hl_context *context, hl_dicom_vectors *vectors);

/* The slice of a frame, counted from 0. If the file states no slices, the result is the frame's index, or 0
 * if the frames are times. */
size_t hl_dicom_vectors_slice(const hl_dicom_vectors *vectors, size_t frame);
/* A number that is the same for all frames of a volume, and greater for each later volume. The result is NAN
 * if the vectors do not distinguish volumes. */
double hl_dicom_vectors_volume(const hl_dicom_vectors *vectors, size_t frame);
/* Returns whether the frames are projections from several directions instead of slices. */
bool hl_dicom_vectors_are_projections(const hl_dicom_vectors *vectors);

#endif
