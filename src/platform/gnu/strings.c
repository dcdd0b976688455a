/* platform/gnu/strings.c - implements functions of GNU's <string.h> for systems whose C library lacks
 * them. */
#include <stdbool.h>
#include <stddef.h>

int strverscmp(const char *a, const char *b);
void *memrchr(const void *bytes, int byte, size_t count);

void *memrchr(const void *bytes, int byte, size_t count) {
  const unsigned char *begin = bytes;
  while (count > 0)
    if (begin[--count] == (unsigned char)byte) return (void *)(begin + count);
  return NULL;
}

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

static size_t digits_at(const char *text) {
  size_t count = 0;
  while (is_digit(text[count])) count++;
  return count;
}

/* Compares names; numbers within names are compared by their values. Numbers that begin with zeros count as
 * fractions and come before all other numbers: 000, 00, 01, 010, 09, 0, 1, 9, 10. */
int strverscmp(const char *a, const char *b) {
  size_t same = 0, begin = 0; /* `same` is the index of the first character that differs, and `begin` is the
                               * index of the first digit of the number to which this character belongs */
  bool zeros = true;          /* whether the characters from `begin` to `same` - 1 are all '0' */
  for (; a[same] == b[same]; same++) {
    if (a[same] == '\0') return 0;
    if (!is_digit(a[same])) begin = same + 1, zeros = true;
    else if (a[same] != '0') zeros = false;
  }
  bool digit_a = is_digit(a[same]), digit_b = is_digit(b[same]);
  if (is_digit(a[begin]) && is_digit(b[begin]) && a[begin] != '0' && b[begin] != '0') {
    size_t of_a = digits_at(a + same), of_b = digits_at(b + same);
    if (of_a != of_b) return of_a < of_b ? -1 : 1; /* the longer number is greater */
  } else if (zeros && begin < same && (digit_a || digit_b)) {
    if (digit_a != digit_b)
      return digit_a ? -1 : 1; /* behind equal zeros, digits sort before all other characters */
  }
  return (unsigned char)a[same] - (unsigned char)b[same];
}
