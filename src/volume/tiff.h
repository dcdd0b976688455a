/* volume/tiff.h - reads the pages of a TIFF file: tiff_load.c, or tiff_absent.c in builds without libtiff. */
#ifndef HL_VOLUME_TIFF_H
#define HL_VOLUME_TIFF_H

#include "volume/format.h"

hl_status hl_tiff_load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error);

#endif
