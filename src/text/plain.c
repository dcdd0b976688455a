/* text/plain.c - see plain.h. */
#define _GNU_SOURCE
#include "text/plain.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Returns the locale "C". The C library has one permanent object for this locale, so that the call allocates
 * nothing and cannot fail. */
static locale_t plain_locale(void) { return newlocale(LC_ALL_MASK, "C", (locale_t)0); }

hl_plain_section hl_plain_begin(void) { return (hl_plain_section){uselocale(plain_locale())}; }

void hl_plain_end(hl_plain_section section) { uselocale((locale_t)section.before); }

double hl_plain_number(const char *text, char **end) { return strtod_l(text, end, plain_locale()); }

int hl_plain_vprint(char *text, size_t size, const char *format, va_list arguments) {
  hl_plain_section section = hl_plain_begin();
  int length = vsnprintf(text, size, format, arguments);
  hl_plain_end(section);
  return length;
}

int hl_plain_print(char *text, size_t size, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  int length = hl_plain_vprint(text, size, format, arguments);
  va_end(arguments);
  return length;
}

static char lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c; }

bool hl_plain_equal(const char *a, const char *b) {
  for (; *a != 0 && lower(*a) == lower(*b); a++) b++;
  return lower(*a) == lower(*b);
}

bool hl_plain_equal_bytes(const char *a, const char *b, size_t length) {
  size_t n = 0;
  while (n < length && a[n] != 0 && lower(a[n]) == lower(b[n])) n++;
  return n == length || (a[n] == 0 && b[n] == 0);
}

bool hl_plain_is_url(const char *text) {
  return strncmp(text, "http://", 7) == 0 || strncmp(text, "https://", 8) == 0;
}

bool hl_plain_is_stream(const char *path) {
  return strcmp(path, "/dev/stdin") == 0 || strncmp(path, "/dev/fd/", 8) == 0;
}
