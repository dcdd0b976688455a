/* volume/formats/dicom/frame.h - reads the pixels of one frame, and decodes them to numbers. */
#ifndef HL_VOLUME_DICOM_FRAME_H
#define HL_VOLUME_DICOM_FRAME_H

#include "volume/formats/dicom/set.h"

/* One thread's memory for reading frames. All bytes of a new workspace must be zero. */
typedef struct hl_dicom_workspace {
  hl_context *context;
  unsigned char *packed; /* owned; a frame as it is stored in the file */
  size_t packed_capacity;
  unsigned char *values; /* owned; a frame's values, [rows][columns][samples], each of value_bytes */
  size_t values_capacity, value_bytes;
  bool is_float;
} hl_dicom_workspace;

void hl_dicom_workspace_release(hl_dicom_workspace *space);

/* Finds where each frame of an encapsulated file with several frames begins. */
hl_status hl_dicom_find_frames(const hl_dicom_set *set, hl_dicom_file *file, hl_error *error);

/* Reads a frame into the workspace's values. The values become integers of 8, 16 or 32 bits, floats or
 * doubles. Signed integers have their sign bit at the top. Colours become RGB. */
hl_status hl_dicom_read_frame(const hl_dicom_set *set, const hl_dicom_frame *frame, hl_dicom_workspace *space,
                              hl_error *error);

#endif
