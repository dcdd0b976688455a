/* volume/tiff_absent.c - refuses TIFF files, in builds without libtiff. */
#include "volume/tiff.h"

hl_status hl_tiff_load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  (void)request, (void)volume;
  return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: a TIFF file, and this program was built without libtiff",
                 (*stream)->path);
}
