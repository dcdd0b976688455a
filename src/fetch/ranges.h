/* fetch/ranges.h - writes requests for a part of a file, and reads the answers of servers.
 *
 * Source: RFC 9110, sections 14.1.2 (ranges of bytes), 14.4 (Content-Range) and 15.3.7 (206 Partial Content).
 * A server may answer 206 with the part, or 200 with the whole file. */
#ifndef HL_FETCH_RANGES_H
#define HL_FETCH_RANGES_H

#include <stdbool.h>

#include <halflight/context.h>

enum { RANGE_BYTES = 64 };

/* Writes a range in the form of the header "Range", without "bytes=". The text is "0-99", or "-100" for the
 * last bytes, or "" for the whole file. Returns false if there are no such bytes. */
bool range_write(const hl_fetch_range *range, char text[RANGE_BYTES]);

/* Returns whether the header "Content-Range" states that an answer has exactly the wanted bytes, and at least
 * one byte. Sets file->begin, file->size and file->whole to the numbers in the header. */
bool range_is_answered(const hl_fetch_range *range, const char *content_range, hl_fetched_file *file);

#endif
