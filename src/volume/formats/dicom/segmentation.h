/* volume/formats/dicom/segmentation.h - reads the voxels of a segmentation whose frames are masks or
 * fractions of segments. */
#ifndef HL_VOLUME_DICOM_SEGMENTATION_H
#define HL_VOLUME_DICOM_SEGMENTATION_H

#include "volume/formats/dicom/stack.h"
#include "volume/formats/format.h"

/* Reads a stack that has segments (stack.h). Masks become a label map whose values are the segments' numbers.
 * The label map has one component if no segments overlap. Overlapping segments are put into different
 * components. If frames are fractions, each segment is an array, and the chosen array is read. */
hl_status hl_dicom_segmentation_read(hl_dicom_set *set, hl_dicom_stack *stack, hl_load_request *request,
                                     hl_volume **volume, hl_error *error);

/* Gives a volume the names and colours of its file's segments. layers: [segments->count]; the component of
 * each segment; null if all segments belong to the first component. */
hl_status hl_dicom_name_segments(const hl_dicom_segments *segments, const int *layers, hl_volume *volume,
                                 hl_error *error);

#endif
