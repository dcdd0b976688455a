/* fetch/ranges.c - see ranges.h. */
#include "ranges.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool range_write(const hl_fetch_range *range, char text[RANGE_BYTES]) {
  text[0] = '\0';
  if (range->count == 0) return true;
  if (range->begin == UINT64_MAX) {
    snprintf(text, RANGE_BYTES, "-%" PRIu64, range->count);
    return true;
  }
  if (range->count - 1 > UINT64_MAX - range->begin) return false;
  snprintf(text, RANGE_BYTES, "%" PRIu64 "-%" PRIu64, range->begin, range->begin + (range->count - 1));
  return true;
}

/* Reads a number of decimal digits, and the character after it. *text is moved past this character. */
static bool read_number(const char **text, char after, uint64_t *number) {
  char *end;
  if ((*text)[0] < '0' || (*text)[0] > '9') return false;
  errno = 0;
  *number = strtoull(*text, &end, 10);
  if (errno != 0 || *end != after) return false;
  *text = end + (after != '\0');
  return true;
}

bool range_is_answered(const hl_fetch_range *range, const char *content_range, hl_fetched_file *file) {
  static const char unit[] = "bytes ";
  const char *text = content_range + sizeof unit - 1;
  uint64_t first, last, whole;
  if (strncmp(content_range, unit, sizeof unit - 1) != 0) return false;
  if (!read_number(&text, '-', &first) || !read_number(&text, '/', &last) ||
      !read_number(&text, '\0', &whole))
    return false;
  if (first > last || last >= whole) return false;
  file->begin = first;
  file->size = last - first + 1;
  file->whole = whole;
  if (range->begin != UINT64_MAX) return first == range->begin && file->size == range->count;
  return last == whole - 1 && file->size == (range->count < whole ? range->count : whole);
}
