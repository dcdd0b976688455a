/* film/keys.c - reads keys, and finds their values at a frame. */
#define _GNU_SOURCE
#include "keys.h"
#include "text/color.h"
#include "text/plain.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

__attribute__((format(printf, 2, 3))) static hl_status refuse(hl_error *error, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(error->message, sizeof error->message, format, arguments);
  va_end(arguments);
  return HL_ERROR_ARGUMENT;
}

/* Reads a number, or a colour as #rrggbb or a CSS name. Returns the number of its components: 1 or 3; 0 if
 * the text is neither. */
static int read_value(const char *text, int length, double value[3]) {
  char *end, color[64];
  value[0] = hl_plain_number(text, &end);
  if (end == text + length && length > 0) return isfinite(value[0]) ? 1 : 0;
  if (length >= (int)sizeof color) return 0;
  snprintf(color, sizeof color, "%.*s", length, text);
  return hl_parse_color(color, 0, 1, value) ? 3 : 0;
}

/* Reads a number of a frame, or a time such as "1.5s", up to the colon behind it. Returns false if the text
 * is neither. */
static bool read_frame(const char *text, double frames_per_second, int *frame, const char **colon) {
  char *end;
  double number = *text >= '0' && *text <= '9' ? (double)strtol(text, &end, 10) : -1;
  if (number >= 0 && *end != ':') {
    number = round(hl_plain_number(text, &end) * frames_per_second);
    if (*end++ != 's') return false;
  }
  if (!(number >= 0 && number <= FILM_MOST_FRAMES) || *end != ':') return false;
  *frame = (int)number;
  *colon = end;
  return true;
}

/* Reads "FRAME:VALUE" at *at, and moves *at behind it. The first point of a key sets its components. */
static hl_status read_point(const char **at, double frames_per_second, film_key *key, int *frame,
                            double *values, hl_error *error) {
  const char *end;
  int length = (int)strcspn(*at, ",");
  if (!read_frame(*at, frames_per_second, frame, &end))
    return refuse(error,
                  "%s: '%.*s' is no FRAME:VALUE: frames are counted from 0, as in 0:10,48:35, and seconds "
                  "have an s, as in 0s:10,2s:35",
                  key->path, length, *at);
  const char *text = end + 1;
  end += 1 + strcspn(text, ",");
  double value[3];
  int components = read_value(text, (int)(end - text), value);
  if (components == 0)
    return refuse(error,
                  "%s: '%.*s' has no finite number after its frame, and no colour (#rrggbb or a CSS name)",
                  key->path, length, *at);
  if (key->count > 0 && components != key->components)
    return refuse(error, "%s: '%.*s': a key has either numbers or colours", key->path, length, *at);
  key->components = components;
  memcpy(values + key->count * (size_t)components, value, (size_t)components * sizeof *value);
  if (key->count > 0 && *frame <= key->frames[key->count - 1])
    return refuse(error, "%s: frame %d does not come after frame %d", key->path, *frame,
                  key->frames[key->count - 1]);
  *at = *end == ',' ? end + 1 : end;
  return *end == ',' && **at == '\0' ? refuse(error, "%s: nothing follows the last comma", key->path) : HL_OK;
}

hl_status film_key_read(const char *text, double frames_per_second, film_key *key, hl_error *error) {
  *key = (film_key){0};
  const char *equals = strchr(text, '=');
  if (equals == NULL || equals == text || equals[1] == '\0')
    return refuse(error, "'%s' is no PATH=FRAME:VALUE,...: write it as lights.0.intensity=0:1,48:2", text);
  size_t most = 1;
  for (const char *c = equals; *c != '\0'; c++) most += *c == ',';
  if (most > FILM_MOST_POINTS) return refuse(error, "more than %d points", (int)FILM_MOST_POINTS);
  key->path = strndup(text, (size_t)(equals - text));
  key->frames = calloc(most, sizeof *key->frames);
  key->values = calloc(3 * most, sizeof *key->values);
  if (key->path == NULL || key->frames == NULL || key->values == NULL) {
    refuse(error, "out of memory for keys");
    return HL_ERROR_MEMORY;
  }
  const char *at = equals + 1;
  hl_status status = HL_OK;
  while (status == HL_OK && *at != '\0') {
    status = read_point(&at, frames_per_second, key, &key->frames[key->count], key->values, error);
    if (status == HL_OK) key->count++;
  }
  return status;
}

void film_key_release(film_key *key) {
  free(key->path);
  free(key->frames);
  free(key->values);
  *key = (film_key){0};
}

double film_key_value(const film_key *key, int frame, int component) {
  /* the values of the component, beginning with the first point */
  const double *values = key->values + component;
  const int stride = key->components;
  if (frame <= key->frames[0]) return values[0];
  for (size_t p = 1; p < key->count; p++, values += stride) {
    if (frame > key->frames[p]) continue;
    double span = key->frames[p] - key->frames[p - 1], past = frame - key->frames[p - 1];
    if (frame == key->frames[p]) return values[stride]; /* exactly the given value, without rounding */
    double part = past / span;
    /* Hermite's cubic from 0 to 1, whose slope is 0 at both ends */
    if (key->smooth) part = part * part * (3 - 2 * part);
    return values[0] + (values[stride] - values[0]) * part;
  }
  return values[0];
}
