/* core/endings.h - makes the lists of endings in hl_file_format. */
#ifndef HL_CORE_ENDINGS_H
#define HL_CORE_ENDINGS_H

#include <halflight/formats.h>
#include <stdio.h>
#include <string.h>

enum { HL_ENDINGS_BYTES = sizeof((hl_file_format *)0)->read_endings };

/* Adds an ending, or several endings separated by blanks, to a list. endings: [HL_ENDINGS_BYTES]. */
static inline void hl_endings_add(char *endings, const char *ending) {
  size_t used = strlen(endings);
  snprintf(endings + used, HL_ENDINGS_BYTES - used, "%s%s", used > 0 ? " " : "", ending);
}

#endif
