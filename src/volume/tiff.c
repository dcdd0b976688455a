/* volume/tiff.c - TIFF and BigTIFF: stacks of pages, OME-TIFF (also of several files), ImageJ's hyperstacks.
 */
#include <string.h>

#include "volume/tiff.h"

static bool has_content(const unsigned char *bytes, size_t length) {
  return length >= 4 && (memcmp(bytes, "II*\0", 4) == 0 || memcmp(bytes, "MM\0*", 4) == 0 ||
                         memcmp(bytes, "II+\0", 4) == 0 || memcmp(bytes, "MM\0+", 4) == 0);
}

const hl_format hl_format_tiff = {.name = "TIFF",
                                  .endings = {".tif", ".tiff"},
                                  .beginning = "\"II*\" or \"MM\"",
                                  .has_content = has_content,
                                  .load = hl_tiff_load};
