/* cli/json_writer.c - writes JSON to stdout. */
#include "json_writer.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "text/json_value.h"

static void print_text(const char *text) {
  char piece[HL_JSON_PIECE_BYTES];
  putchar('"');
  for (size_t length; (length = hl_json_piece(&text, piece)) > 0;) fwrite(piece, 1, length, stdout);
  putchar('"');
}

static void print_number(double value) {
  char text[HL_JSON_NUMBER_BYTES] = "null";
  if (isfinite(value)) hl_json_number_text(value, text);
  fputs(text, stdout);
}

/* Writes the comma, the new line, the indentation and the key before a value. */
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

void json_whole_number(json_writer *writer, const char *key, uint64_t value) {
  begin_value(writer, key);
  printf("%" PRIu64, value);
}

void json_signed_number(json_writer *writer, const char *key, int64_t value) {
  begin_value(writer, key);
  printf("%" PRId64, value);
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

void json_written(json_writer *writer, const char *key, const char *value) {
  begin_value(writer, key);
  fputs(value, stdout);
}

void json_whole_numbers(json_writer *writer, const char *key, const uint64_t *values, size_t count) {
  begin_value(writer, key);
  for (size_t i = 0; i < count; i++) printf("%s%" PRIu64, i == 0 ? "[" : ", ", values[i]);
  putchar(']');
}
