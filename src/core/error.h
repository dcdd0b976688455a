/* core/error.h - reports failures of functions: by a status, and by a line of text for users. */
#ifndef HL_CORE_ERROR_H
#define HL_CORE_ERROR_H

#include <halflight/context.h>

/* Fills *error (which may be null) with a formatted line, and returns `code`. */
__attribute__((format(printf, 3, 4))) hl_status hl_fail(hl_error *error, hl_status code, const char *format,
                                                        ...);

/* Fails like hl_fail(), and stores the line and the column of the input at which the error lies. Line and
 * column are counted from 1; 0 means unknown. */
__attribute__((format(printf, 5, 6))) hl_status hl_fail_at(hl_error *error, hl_status code, int line,
                                                           int column, const char *format, ...);

/* Fails like hl_fail(), and stores the byte offset in the input at which the error lies. */
__attribute__((format(printf, 4, 5))) hl_status hl_fail_offset(hl_error *error, hl_status code,
                                                               int64_t offset, const char *format, ...);

/* Fails with the line "out of memory: NAME needs N bytes ...". */
hl_status hl_fail_memory(hl_error *error, size_t bytes, const char *what);

/* Replaces control characters by '?'. Names in foreign files may hold control characters, but a message must
 * be one line and must not control the terminal. */
void hl_make_printable(char *line);

#endif
