/* cli/json_writer.c - JSON on stdout. */
#include "json_writer.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Bytes of the well-formed UTF-8 sequence at c, 0 if it is none (RFC 3629). */
static int utf8_length(const unsigned char *c) {
  static const unsigned char least_second[4] = {0x80, 0x80, 0xa0, 0x90}; /* for 0xe0 and 0xf0: not overlong */
  int length = c[0] < 0x80 ? 1 : c[0] < 0xc2 ? 0 : c[0] < 0xe0 ? 2 : c[0] < 0xf0 ? 3 : c[0] < 0xf5 ? 4 : 0;
  for (int i = 1; i < length; i++)
    if ((c[i] & 0xc0) != 0x80) return 0;
  if ((c[0] == 0xe0 || c[0] == 0xf0) && c[1] < least_second[length - 1]) return 0;
  if ((c[0] == 0xed && c[1] > 0x9f) || (c[0] == 0xf4 && c[1] > 0x8f))
    return 0; /* surrogates; beyond Unicode */
  return length;
}

/* File names need not be UTF-8, JSON must be: other bytes become U+FFFD. */
static void print_text(const char *text) {
  putchar('"');
  for (const unsigned char *c = (const unsigned char *)text; *c != '\0';) {
    int length = utf8_length(c);
    if (*c == '"' || *c == '\\') printf("\\%c", *c);
    else if (*c < 0x20) printf("\\u%04x", *c);
    else if (length == 0) fputs("\\ufffd", stdout);
    else fwrite(c, 1, (size_t)length, stdout);
    c += length > 0 ? length : 1;
  }
  putchar('"');
}

/* The shortest of 15, 16 or 17 digits that reads back as the same number. */
static void print_number(double value) {
  if (!isfinite(value)) {
    fputs("null", stdout);
    return;
  }
  char text[40];
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(text, sizeof text, "%.*g", digits, value);
    if (strtod(text, NULL) == value) break;
  }
  fputs(text, stdout);
}

/* Comma, line, indentation and key before a value. */
static void begin_value(json_writer *writer, const char *key) {
  if (writer->depth > 0) printf("%s\n%*s", writer->first ? "" : ",", 2 * writer->depth, "");
  writer->first = false;
  if (key == NULL) return;
  print_text(key);
  fputs(": ", stdout);
}

static void open_level(json_writer *writer, const char *key, char open, char close) {
  begin_value(writer, key);
  putchar(open);
  if (writer->depth < (int)sizeof writer->close) writer->close[writer->depth] = close;
  writer->depth++;
  writer->first = true;
}

void json_open_object(json_writer *writer, const char *key) { open_level(writer, key, '{', '}'); }

void json_open_array(json_writer *writer, const char *key) { open_level(writer, key, '[', ']'); }

void json_close(json_writer *writer) {
  writer->depth--;
  if (!writer->first) printf("\n%*s", 2 * writer->depth, "");
  putchar(writer->close[writer->depth]);
  writer->first = false;
  if (writer->depth == 0) putchar('\n');
}

void json_text(json_writer *writer, const char *key, const char *value) {
  begin_value(writer, key);
  if (value == NULL) fputs("null", stdout);
  else print_text(value);
}

void json_bool(json_writer *writer, const char *key, bool value) {
  begin_value(writer, key);
  fputs(value ? "true" : "false", stdout);
}

void json_integer(json_writer *writer, const char *key, uint64_t value) {
  begin_value(writer, key);
  printf("%" PRIu64, value);
}

void json_number(json_writer *writer, const char *key, double value) {
  begin_value(writer, key);
  print_number(value);
}

void json_numbers(json_writer *writer, const char *key, const double *values, size_t count) {
  begin_value(writer, key);
  for (size_t i = 0; i < count; i++) {
    fputs(i == 0 ? "[" : ", ", stdout);
    print_number(values[i]);
  }
  putchar(']');
}

void json_integers(json_writer *writer, const char *key, const uint64_t *values, size_t count) {
  begin_value(writer, key);
  for (size_t i = 0; i < count; i++) printf("%s%" PRIu64, i == 0 ? "[" : ", ", values[i]);
  putchar(']');
}
