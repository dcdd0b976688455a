/* volume/dicom/directory.h - DICOMDIR: the file that lists the files of a disc (PS3.10, chapter 8). */
#ifndef HL_VOLUME_DICOM_DIRECTORY_H
#define HL_VOLUME_DICOM_DIRECTORY_H

#include "volume/bundle.h"

/* Lists the files that a DICOMDIR names, those that are there, as the bundle's entries. Another DICOM file
 * names none. */
hl_status hl_dicom_directory_read(hl_source **source, hl_bundle *bundle, hl_error *error);

#endif
