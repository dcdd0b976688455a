/* volume/nanovdb.c - NanoVDB: sparse grids of smoke, fire and level sets, as dense volumes. */
#include "volume/nanovdb.h"

#include <string.h>

/* "NanoVDB0" begins a file of any kind up to version 32.5, "NanoVDB2" a file since. */
static bool has_content(const unsigned char *bytes, size_t length) {
  return length >= 8 && memcmp(bytes, "NanoVDB", 7) == 0 && (bytes[7] == '0' || bytes[7] == '2');
}

const hl_format hl_format_nanovdb = {.name = "NanoVDB",
                                     .endings = {".nvdb"},
                                     .beginning = "\"NanoVDB\"",
                                     .has_content = has_content,
                                     .load = hl_nanovdb_load};
