/* volume/formats/vdb/nanovdb.h - reads NanoVDB's grids. The functions are in nanovdb_load.c, or in
 * nanovdb_absent.c in a build without PNanoVDB.h. */
#ifndef HL_VOLUME_NANOVDB_H
#define HL_VOLUME_NANOVDB_H

#include "volume/formats/format.h"

hl_status hl_nanovdb_load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error);

/* Returns "PNanoVDB.h" in builds without it, else null. */
const char *hl_nanovdb_missing(void);

#endif
