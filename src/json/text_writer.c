/* json/text_writer.c - see text_writer.h. */
#include "json/text_writer.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "text/json_value.h"
#include "text/plain.h"
#include "text/plain_json.h"

static void put(hl_json_writer *w, const char *text, size_t length) {
  if (!w->failed && w->length + length + 1 > w->capacity) {
    size_t capacity = 2 * w->capacity + length + 1024;
    char *grown = hl_reallocate(w->context, w->text, capacity, 1);
    if (grown == NULL) w->failed = true;
    else w->text = grown, w->capacity = capacity;
  }
  if (w->failed) return;
  memcpy(w->text + w->length, text, length);
  w->length += length;
  w->text[w->length] = 0;
}

void hl_json_put_text(hl_json_writer *w, const char *text) { put(w, text, strlen(text)); }

void hl_json_begin_item(hl_json_writer *w, const char *key) {
  hl_json_put_text(w, w->first ? "\n" : ",\n");
  w->first = false;
  for (int d = 0; d < w->depth; d++) hl_json_put_text(w, "  ");
  if (key == NULL) return;
  hl_json_put_text(w, "\"");
  hl_json_put_text(w, key);
  hl_json_put_text(w, "\": ");
}

void hl_json_open(hl_json_writer *w, const char *key, const char *bracket) {
  if (w->depth > 0) hl_json_begin_item(w, key);
  hl_json_put_text(w, bracket);
  w->depth++;
  w->first = true;
}

void hl_json_close(hl_json_writer *w, const char *bracket) {
  bool empty = w->first;
  w->depth--;
  w->first = true;
  if (!empty) hl_json_begin_item(w, NULL);
  hl_json_put_text(w, bracket);
  w->first = false;
}

static void put_number(hl_json_writer *w, double number) {
  char text[HL_JSON_NUMBER_BYTES];
  hl_json_number_text(number, text);
  hl_json_put_text(w, text);
}

static void put_quoted(hl_json_writer *w, const char *text) {
  char piece[HL_JSON_PIECE_BYTES];
  hl_json_put_text(w, "\"");
  for (size_t length; (length = hl_json_piece(&text, piece)) > 0;) put(w, piece, length);
  hl_json_put_text(w, "\"");
}

void hl_json_write_number(hl_json_writer *w, const char *key, double number) {
  hl_json_begin_item(w, key);
  put_number(w, number);
}

void hl_json_write_whole(hl_json_writer *w, const char *key, int64_t number) {
  char text[HL_JSON_NUMBER_BYTES];
  hl_json_begin_item(w, key);
  snprintf(text, sizeof text, "%" PRId64, number);
  hl_json_put_text(w, text);
}

void hl_json_write_row(hl_json_writer *w, const char *key, const double *numbers, size_t count) {
  hl_json_begin_item(w, key);
  hl_json_put_text(w, "[");
  for (size_t n = 0; n < count; n++) {
    if (n > 0) hl_json_put_text(w, ", ");
    put_number(w, numbers[n]);
  }
  hl_json_put_text(w, "]");
}

void hl_json_write_name(hl_json_writer *w, const char *key, const char *name) {
  hl_json_begin_item(w, key);
  put_quoted(w, name);
}

void hl_json_write_flag(hl_json_writer *w, const char *key, int flag) {
  hl_json_begin_item(w, key);
  hl_json_put_text(w, flag ? "true" : "false");
}
