/* volume/formats/tiff/tiff.h - reads the pages of a TIFF file. The functions are in tiff_load.c, or in builds
 * without libtiff in tiff_absent.c. */
#ifndef HL_VOLUME_TIFF_H
#define HL_VOLUME_TIFF_H

#include "volume/formats/format.h"
#include "volume/io/bundle.h"

/* Loads a TIFF file. archive: the archive that contains the stream's file and the other files of its volume;
 * null if the files are in a folder. */
hl_status hl_tiff_load(hl_stream **stream, const hl_bundle *archive, hl_load_request *request,
                       hl_volume **volume, hl_error *error);

/* Returns "libtiff" in builds without it, else null. */
const char *hl_tiff_missing(void);

#endif
