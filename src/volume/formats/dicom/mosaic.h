/* volume/formats/dicom/mosaic.h - describes mosaics. A mosaic is a picture that holds all slices of a volume,
 * as Siemens' scanners write it.
 *
 * A mosaic of n slices has ceil(sqrt(n)) tiles along each side, in the order of rows; the last tiles may be
 * empty. The number of slices and their normal are stored in private elements. Source: the layout that
 * nibabel and dcm2niix read ("CSA headers"). */
#ifndef HL_VOLUME_DICOM_MOSAIC_H
#define HL_VOLUME_DICOM_MOSAIC_H

#include "volume/formats/dicom/elements.h"

typedef struct hl_dicom_mosaic {
  unsigned header_block, csa_block; /* numbers of the private blocks in the groups 0019 and 0029; 0 until a
                                     * block is found */
  double slices;                    /* number of slices; 0 if not stated */
  double normal[3];                 /* the direction from slice to slice; 0 if not stated */
} hl_dicom_mosaic;

/* Examines an element at the top level of a file, and stores the facts about a mosaic that the element
 * states. Elements without facts about a mosaic change nothing. */
hl_status hl_dicom_mosaic_take(hl_dicom_reader *reader, const hl_dicom_element *element,
                               hl_dicom_mosaic *mosaic, hl_error *error);

#endif
