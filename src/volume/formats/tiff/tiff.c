/* volume/formats/tiff/tiff.c - reads TIFF and BigTIFF files: stacks of pages, OME-TIFF (also of several
 * files), and ImageJ's hyperstacks. */
#include <string.h>

#include "volume/formats/tiff/tiff.h"

/* Returns whether the content is TIFF. A DICOM file may begin like a TIFF file, so that the file is valid as
 * DICOM and as TIFF (PS3.10, 7.1); the DICOM reader reads files that are valid as both. */
static bool has_content(const unsigned char *bytes, size_t length) {
  if (length >= 132 && memcmp(bytes + 128, "DICM", 4) == 0) return false;
  return length >= 4 && (memcmp(bytes, "II*\0", 4) == 0 || memcmp(bytes, "MM\0*", 4) == 0 ||
                         memcmp(bytes, "II+\0", 4) == 0 || memcmp(bytes, "MM\0+", 4) == 0);
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  return hl_tiff_load(stream, NULL, request, volume, error);
}

const hl_format hl_format_tiff = {.name = "TIFF",
                                  .missing = hl_tiff_missing,
                                  .endings = {".tif", ".tiff"},
                                  .beginning = "\"II*\" or \"MM\"",
                                  .has_content = has_content,
                                  .load = load};
