/* volume/formats/vdb/nanovdb_absent.c - refuses NanoVDB files in a build without PNanoVDB.h. */
#include "volume/formats/vdb/nanovdb.h"

hl_status hl_nanovdb_load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  (void)request, (void)volume;
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "%s: a NanoVDB file, and this program was built without PNanoVDB.h: install libnanovdb-dev "
                 "and build anew",
                 (*stream)->path);
}

const char *hl_nanovdb_missing(void) { return "PNanoVDB.h"; }
