/* json/text_writer.h - writes JSON text piece by piece, indented, with each member and element on a line of
 * its own.
 *
 * A number is written with the least number of digits from which the same double is read again. A row of
 * numbers stays on one line. */
#ifndef HL_JSON_TEXT_WRITER_H
#define HL_JSON_TEXT_WRITER_H

#include <stdbool.h>

#include "core/context.h"

/* A JSON text that is being written. After a failed allocation `failed` is set, and nothing more is
 * written. */
typedef struct hl_json_writer {
  hl_context *context;
  char *text; /* owned; the text written so far; ends with 0 */
  size_t length, capacity;
  int depth;
  const char *beside; /* the folder to which names of files are made relative (file_names.h); null if names
                       * are not changed */
  bool first;         /* whether nothing has been written yet at this depth of the text */
  bool failed;
} hl_json_writer;

void hl_json_put_text(hl_json_writer *w, const char *text);

/* Begins a member or an element: writes a comma if needed, a new line, the indentation, and the key. key:
 * null for an element, which has no key. */
void hl_json_begin_item(hl_json_writer *w, const char *key);

/* hl_json_open() begins an object or a list, and hl_json_close() ends it. bracket: "{" or "[" to begin, "}"
 * or "]" to end. key: null in a list. */
void hl_json_open(hl_json_writer *w, const char *key, const char *bracket);
void hl_json_close(hl_json_writer *w, const char *bracket);

/* Functions that write members of an object, or elements of a list if `key` is null. */
void hl_json_write_number(hl_json_writer *w, const char *key, double number);
void hl_json_write_whole(hl_json_writer *w, const char *key, int64_t number);
void hl_json_write_row(hl_json_writer *w, const char *key, const double *numbers, size_t count);
void hl_json_write_name(hl_json_writer *w, const char *key, const char *name);
void hl_json_write_flag(hl_json_writer *w, const char *key, int flag);

#endif
