/* volume/io/text.c - reads words and numbers of text headers.
 *
 * The functions of text.c do not depend on the program's locale. The conversions of the C library depend on
 * the locale, and in some locales do not accept "1.5" as a number. */
#include "volume/io/text.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "text/plain.h"

static char lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c; }
static bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool hl_text_starts(const char *text, const char *prefix) {
  while (*prefix != 0 && lower(*text) == lower(*prefix)) {
    text++;
    prefix++;
  }
  return *prefix == 0;
}

bool hl_text_equal(const char *a, const char *b) { return strlen(a) == strlen(b) && hl_text_starts(a, b); }

bool hl_text_ends(const char *text, const char *suffix) {
  size_t length = strlen(text), suffix_length = strlen(suffix);
  return length >= suffix_length && hl_text_equal(text + length - suffix_length, suffix);
}

bool hl_text_is_one_of(const char *text, const char *alternatives) {
  size_t length = strlen(text);
  for (const char *each = alternatives;; each++) {
    if (hl_text_starts(each, text) && (each[length] == 0 || each[length] == '|')) return true;
    each = strchr(each, '|');
    if (each == NULL) return false;
  }
}

/* A number that a text gives as sign digits [. digits] [e sign digits]. The number's value is mantissa *
 * 10^exponent. long_form: whether the number has too many digits for the mantissa. */
typedef struct decimal {
  bool negative, long_form;
  uint64_t mantissa;
  int exponent;
} decimal;

static bool scan_exponent(const char *text, const char *end, int *exponent) {
  bool negative = text < end && *text == '-';
  if (text < end && (*text == '-' || *text == '+')) text++;
  if (text == end) return false;
  int value = 0;
  for (; text < end && is_digit(*text); text++)
    if (value < 100000) value = 10 * value + (*text - '0');
  *exponent += negative ? -value : value;
  return text == end;
}

static bool scan_decimal(const char *text, const char *end, decimal *number) {
  *number = (decimal){0};
  if (text < end && (*text == '-' || *text == '+')) number->negative = *text++ == '-';
  bool any = false, point = false;
  for (; text < end && (is_digit(*text) || (*text == '.' && !point)); text++) {
    if (*text == '.') {
      point = true;
      continue;
    }
    any = true;
    if (number->mantissa > (UINT64_MAX - 9) / 10) number->long_form = true;
    else number->mantissa = 10 * number->mantissa + (uint64_t)(*text - '0');
    if (point) number->exponent--;
  }
  if (!any) return false;
  if (text < end && (*text == 'e' || *text == 'E')) return scan_exponent(text + 1, end, &number->exponent);
  return text == end;
}

static bool scan_special(const char *text, size_t length, double *value) {
  char word[10] = {0};
  bool negative = *text == '-';
  if (*text == '-' || *text == '+') {
    text++;
    length--;
  }
  if (length == 0 || length >= sizeof word) return false;
  memcpy(word, text, length);
  if (hl_text_equal(word, "nan")) *value = NAN;
  else if (hl_text_equal(word, "inf") || hl_text_equal(word, "infinity"))
    *value = negative ? -INFINITY : INFINITY;
  else return false;
  return true;
}

/* Converts a number for which the fast conversion is not exact. */
static double convert_slowly(const char *text, size_t length) {
  char copy[HL_NUMBER_CHARACTERS];
  memcpy(copy, text, length);
  copy[length] = 0;
  return hl_plain_number(copy, NULL);
}

bool hl_text_number(const char *text, size_t length, double *value) {
  static const double power_of_ten[23] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                          1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                          1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  decimal number;
  if (length == 0 || length >= HL_NUMBER_CHARACTERS) return false;
  if (!scan_decimal(text, text + length, &number)) return scan_special(text, length, value);
  /* the mantissa and the power of ten are exact as doubles, so that their product or quotient, which is
   * rounded once, is the nearest double (W. D. Clinger, "How to read floating point numbers accurately",
   * 1990, section 2) */
  if (!number.long_form && number.mantissa <= (uint64_t)1 << 53 && number.exponent >= -22 &&
      number.exponent <= 22) {
    double magnitude = number.exponent < 0 ? (double)number.mantissa / power_of_ten[-number.exponent]
                                           : (double)number.mantissa * power_of_ten[number.exponent];
    *value = number.negative ? -magnitude : magnitude;
  } else {
    *value = convert_slowly(text, length);
  }
  return true;
}

bool hl_text_whole(const char *text, int64_t *whole) {
  const size_t length = strlen(text);
  decimal number;
  double value;
  if (scan_decimal(text, text + length, &number) && !number.long_form && number.exponent == 0) {
    if (number.mantissa > (uint64_t)INT64_MAX + number.negative) return false;
    *whole = (int64_t)(number.negative ? 0 - number.mantissa : number.mantissa);
    return true;
  }
  if (!hl_text_number(text, length, &value)) return false;
  if (!(value >= -0x1p63 && value < 0x1p63 && value == floor(value))) return false;
  *whole = (int64_t)value;
  return true;
}

static const char *word_end(const char *text) {
  while (*text != 0 && !hl_is_space(*text)) text++;
  return text;
}

static const char *skip_space(const char *text) {
  while (hl_is_space(*text)) text++;
  return text;
}

int hl_text_numbers(const char *text, double *values, int capacity) {
  int count = 0;
  for (text = skip_space(text); *text != 0; text = skip_space(text)) {
    const char *end = word_end(text);
    if (count == capacity || !hl_text_number(text, (size_t)(end - text), &values[count])) return -1;
    count++;
    text = end;
  }
  return count;
}

int hl_text_sizes(const char *text, size_t *values, int capacity) {
  int count = 0;
  for (text = skip_space(text); *text != 0; text = skip_space(text)) {
    if (count == capacity || !is_digit(*text)) return -1;
    size_t value = 0;
    for (; is_digit(*text); text++)
      if (__builtin_mul_overflow(value, (size_t)10, &value) ||
          __builtin_add_overflow(value, (size_t)(*text - '0'), &value))
        return -1;
    if (*text != 0 && !hl_is_space(*text)) return -1;
    values[count++] = value;
  }
  return count;
}

char *hl_text_trim(char *text) {
  while (hl_is_space(*text)) text++;
  size_t length = strlen(text);
  while (length > 0 && hl_is_space(text[length - 1])) length--;
  text[length] = 0;
  return text;
}

bool hl_text_word(const char **cursor, char *word, size_t capacity) {
  const char *begin = skip_space(*cursor), *end = word_end(begin);
  size_t length = (size_t)(end - begin);
  *cursor = end;
  if (length == 0 || length >= capacity) return false;
  memcpy(word, begin, length);
  word[length] = 0;
  return true;
}

const char *hl_text_printable(char buffer[HL_PRINTABLE_BYTES], const char *text) {
  size_t n = 0;
  for (; n < HL_PRINTABLE_BYTES - 4 && text[n] != 0; n++)
    buffer[n] = text[n] >= ' ' && text[n] <= '~' ? text[n] : '?';
  strcpy(buffer + n, text[n] != 0 ? "..." : "");
  return buffer;
}
