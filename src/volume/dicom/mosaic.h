/* volume/dicom/mosaic.h - the slices of a volume in one picture, as Siemens' scanners write them.
 *
 * A mosaic of n slices has ceil(sqrt(n)) tiles along each side, row by row; the last ones may be empty. Its
 * number of slices and their normal are in private elements. Source: the layout that nibabel and dcm2niix
 * read ("CSA headers"). */
#ifndef HL_VOLUME_DICOM_MOSAIC_H
#define HL_VOLUME_DICOM_MOSAIC_H

#include "volume/dicom/elements.h"

typedef struct hl_dicom_mosaic {
  unsigned header_block, csa_block; /* the private blocks of the groups 0019 and 0029; 0: not seen */
  double slices;                    /* 0: not told */
  double normal[3];                 /* the direction from slice to slice; 0: not told */
} hl_dicom_mosaic;

/* Takes an element at the top of a file. Elements of others change nothing. */
hl_status hl_dicom_mosaic_take(hl_dicom_reader *reader, const hl_dicom_element *element,
                               hl_dicom_mosaic *mosaic, hl_error *error);

#endif
