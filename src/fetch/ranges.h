/* fetch/ranges.h - requests for a part of a file, and what servers answer to them.
 *
 * Source: RFC 9110, sections 14.1.2 (ranges of bytes), 14.4 (Content-Range) and 15.3.7 (206 Partial Content).
 * A server may answer 206 with the part, or 200 with the whole file. */
#ifndef HL_FETCH_RANGES_H
#define HL_FETCH_RANGES_H

#include <stdbool.h>

#include <halflight/context.h>

enum { RANGE_BYTES = 64 };

/* Writes a range as the header "Range" has it, without "bytes=": "0-99" or, for the last bytes, "-100". ""
 * for the whole file. False: there are no such bytes. */
bool range_write(const hl_fetch_range *range, char text[RANGE_BYTES]);

/* Returns whether "Content-Range" says that an answer has exactly the wanted bytes, of which there is one at
 * least. Sets file->begin, file->size and file->whole to what it says. */
bool range_is_answered(const hl_fetch_range *range, const char *content_range, hl_fetched_file *file);

#endif
