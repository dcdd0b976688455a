/* volume/formats/dicom/segments.h - reads the segments that a segmentation object lists: their numbers, names
 * and colours.
 *
 * Source: DICOM PS3.3, C.8.20 (segmentation objects). */
#ifndef HL_VOLUME_DICOM_SEGMENTS_H
#define HL_VOLUME_DICOM_SEGMENTS_H

#include "volume/formats/dicom/elements.h"
#include "volume/volume.h"

enum { HL_DICOM_SEGMENTS = 0x00620002 /* tag of the sequence whose items are segments */ };

typedef enum hl_dicom_segment_kind {
  HL_DICOM_NO_SEGMENTS = 0,
  HL_DICOM_BINARY,     /* each frame is a mask of one segment */
  HL_DICOM_FRACTIONAL, /* each frame has, for one segment, a fraction at each pixel */
  HL_DICOM_LABEL_MAP   /* pixels are numbers of segments */
} hl_dicom_segment_kind;

typedef struct hl_dicom_segments {
  hl_dicom_segment_kind kind;
  double fraction_most;   /* the pixel value that stands for the fraction 1; NAN if not stated */
  hl_segment *list;       /* owned; [count]; `value` is the segment's number */
  size_t count, capacity; /* number of segments; room for segments */
} hl_dicom_segments;

/* Stores the facts about segments that an element states. The element stands at the top level of a file, or
 * within an item of HL_DICOM_SEGMENTS. Elements without facts about segments change nothing. */
hl_status hl_dicom_segments_take(hl_dicom_reader *reader, const hl_dicom_element *element,
                                 hl_dicom_segments *segments, hl_error *error);
void hl_dicom_segments_release(hl_context *context, hl_dicom_segments *segments);

/* The index of the segment with this number; SIZE_MAX if no segment has the number. */
size_t hl_dicom_segment_of(const hl_dicom_segments *segments, double number);

#endif
