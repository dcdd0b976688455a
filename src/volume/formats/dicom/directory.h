/* volume/formats/dicom/directory.h - reads a DICOMDIR, which is the file that lists the files of a disc
 * (PS3.10, chapter 8). */
#ifndef HL_VOLUME_DICOM_DIRECTORY_H
#define HL_VOLUME_DICOM_DIRECTORY_H

#include "volume/io/bundle.h"

/* Reads a DICOMDIR, and adds to the bundle's entries the existing files that the DICOMDIR names. Adds nothing
 * if the source is another kind of DICOM file. */
hl_status hl_dicom_directory_read(hl_source **source, hl_bundle *bundle, hl_error *error);

#endif
