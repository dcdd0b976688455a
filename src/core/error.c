/* core/error.c - returns the names of statuses, and writes error lines. */
#include "core/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "text/plain.h"

const char *hl_status_name(hl_status status) {
  switch (status) {
    case HL_OK: return "ok";
    case HL_ERROR_ARGUMENT: return "impossible argument";
    case HL_ERROR_MEMORY: return "out of memory";
    case HL_ERROR_IO: return "input or output failed";
    case HL_ERROR_INPUT: return "malformed input";
    case HL_ERROR_UNSUPPORTED: return "unsupported";
    case HL_ERROR_CANCELLED: return "cancelled";
    case HL_ERROR_INTERNAL: return "internal error";
  }
  return "unknown status";
}

const char *hl_version(void) { return "0.1.0"; }

void hl_make_printable(char *line) {
  for (; *line != 0; line++)
    if ((unsigned char)*line < 0x20 || *line == 0x7f) *line = '?';
}

static hl_status fail(hl_error *error, hl_status code, int line, int column, int64_t offset,
                      const char *format, va_list arguments) {
  if (error == NULL) return code;
  error->code = code;
  error->line = line;
  error->column = column;
  error->byte_offset = offset;
  hl_plain_vprint(error->message, sizeof error->message, format, arguments);
  hl_make_printable(error->message);
  return code;
}

hl_status hl_fail(hl_error *error, hl_status code, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  fail(error, code, 0, 0, -1, format, arguments);
  va_end(arguments);
  return code;
}

hl_status hl_fail_at(hl_error *error, hl_status code, int line, int column, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  fail(error, code, line, column, -1, format, arguments);
  va_end(arguments);
  return code;
}

hl_status hl_fail_offset(hl_error *error, hl_status code, int64_t offset, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  fail(error, code, 0, 0, offset, format, arguments);
  va_end(arguments);
  return code;
}

hl_status hl_fail_memory(hl_error *error, size_t bytes, const char *what) {
  return hl_fail(error, HL_ERROR_MEMORY,
                 "out of memory: %s needs %zu bytes more than there are or than the limit allows", what,
                 bytes);
}
