/* volume/formats/dicom/stack.h - makes evenly spaced slices of a grid from the frames of a series.
 *
 * The grid's axes run along the rows, along the columns, and from the first slice to the last. The third axis
 * need not be the normal, so that the sheared grid of a tilted gantry is kept. */
#ifndef HL_VOLUME_DICOM_STACK_H
#define HL_VOLUME_DICOM_STACK_H

#include "volume/formats/dicom/set.h"
#include "volume/volume.h"

/* A slice of the grid. A slice lies at a position that has frames, or between two positions that have
 * frames. */
typedef struct hl_dicom_slice {
  size_t place;  /* index of the position at the slice, or else of the last position before the slice */
  double weight; /* weight of the frame at the next position; 0 if the slice lies at the position `place` */
  bool empty;    /* whether the slice lies between two positions and is not interpolated */
} hl_dicom_slice;

typedef struct hl_dicom_stack {
  hl_context *context;
  const hl_dicom_frame **frames; /* owned; [place_count][times]; for segmentations: null if a segment has no
                                  * frame at the position */
  size_t place_count, times;
  const hl_dicom_segments *segments; /* for a segmentation whose frames show one segment each: its segments,
                                      * whose number is `times`; else null */
  size_t empty_count;                /* number of empty slices */
  hl_dicom_slice *slices;            /* owned; [grid.dimensions[2]] */
  hl_volume_description grid;        /* the grid of the slices; only dimensions, origin, axes and space are
                                      * set */
} hl_dicom_stack;

/* Makes the stack. The caller must release the stack also after a failure. */
hl_status hl_dicom_stack_make(const hl_dicom_set *set, size_t series, hl_dicom_stack *stack, hl_error *error);
void hl_dicom_stack_release(hl_dicom_stack *stack);

#endif
