/* volume/dicom/vectors.h - the vectors of nuclear medicine, which tell for each frame its slice, time slot,
 * ...
 *
 * Source: DICOM PS3.3, C.8.4.8 (NM multi-frame), C.7.6.6 (multi-frame). */
#ifndef HL_VOLUME_DICOM_VECTORS_H
#define HL_VOLUME_DICOM_VECTORS_H

#include "volume/dicom/elements.h"

enum { HL_DICOM_VECTORS = 9 };

typedef struct hl_dicom_vector {
  uint16_t *numbers; /* owned; [count]; null: not told */
  size_t count;      /* frames */
} hl_dicom_vector;

typedef struct hl_dicom_vectors {
  hl_dicom_vector list[HL_DICOM_VECTORS];
  bool are_times; /* the frames follow each other in time, as in films of ultrasound or angiography */
} hl_dicom_vectors;

/* Takes an element at the top of a file. Elements of others change nothing. */
hl_status hl_dicom_vectors_take(hl_dicom_reader *reader, const hl_dicom_element *element,
                                hl_dicom_vectors *vectors, hl_error *error);
void hl_dicom_vectors_release(hl_context *context, hl_dicom_vectors *vectors);

/* The frame's slice, from 0; where no slices are told the frame's own index, or 0 of frames that are times.
 */
size_t hl_dicom_vectors_slice(const hl_dicom_vectors *vectors, size_t frame);
/* A number that differs between the volumes that frames belong to, and rises from volume to volume; NAN: no
 * vector tells. */
double hl_dicom_vectors_volume(const hl_dicom_vectors *vectors, size_t frame);
/* Whether the frames are projections from several sides, and no slices. */
bool hl_dicom_vectors_are_projections(const hl_dicom_vectors *vectors);

#endif
