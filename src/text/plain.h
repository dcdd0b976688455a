/* text/plain.h - reads and writes numbers and names in the locale "C", independently of the locale that the
 * host has set. Other functions find out whether a text is a URL or the name of an open stream. In the locale
 * "C", "1.5" is a number, and 'I' and 'i' are the same letter. */
#ifndef HL_TEXT_PLAIN_H
#define HL_TEXT_PLAIN_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

/* Three functions that do the work of strtod(), vsnprintf() and snprintf() in the locale "C". */
double hl_plain_number(const char *text, char **end);
int hl_plain_vprint(char *text, size_t size, const char *format, va_list arguments);
__attribute__((format(printf, 3, 4))) int hl_plain_print(char *text, size_t size, const char *format, ...);

/* Returns whether two texts are equal if the case of the letters A to Z is ignored. */
bool hl_plain_equal(const char *a, const char *b);
/* Returns whether the first `length` bytes of two texts are equal if the case of the letters A to Z is
 * ignored. */
bool hl_plain_equal_bytes(const char *a, const char *b, size_t length);

/* Returns whether a text is a URL of a web server, "http://..." or "https://...". */
bool hl_plain_is_url(const char *text);
/* Returns whether a path is the name of an open stream, such as "/dev/stdin" or "/dev/fd/3". */
bool hl_plain_is_stream(const char *path);

/* Between hl_plain_begin() and hl_plain_end() the calling thread is in the locale "C", for calls of other
 * libraries' functions. */
typedef struct hl_plain_section {
  void *before;
} hl_plain_section;
hl_plain_section hl_plain_begin(void);
void hl_plain_end(hl_plain_section section);

#endif
