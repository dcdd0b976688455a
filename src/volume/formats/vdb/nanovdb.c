/* volume/formats/vdb/nanovdb.c - reads sparse grids, such as smoke, fire and level sets, from NanoVDB
 * files. */
#include "volume/formats/vdb/nanovdb.h"

#include <string.h>

/* Files of all kinds up to version 32.5 begin with "NanoVDB0"; newer files begin with "NanoVDB2". */
static bool has_content(const unsigned char *bytes, size_t length) {
  return length >= 8 && memcmp(bytes, "NanoVDB", 7) == 0 && (bytes[7] == '0' || bytes[7] == '2');
}

const hl_format hl_format_nanovdb = {.name = "NanoVDB",
                                     .missing = hl_nanovdb_missing,
                                     .endings = {".nvdb"},
                                     .beginning = "\"NanoVDB\"",
                                     .has_content = has_content,
                                     .load = hl_nanovdb_load};
