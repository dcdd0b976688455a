/* film/keys.c - reads keys, and finds their values at a frame. */
#define _GNU_SOURCE
#include "keys.h"
#include "elementary/elementary.h"
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

/* Reads one number, or three numbers with commas between. Returns the count of numbers, 1 or 3; 0 if the
 * text has another form.
 */
static int read_numbers(const char *text, const char *end, double value[3]) {
  char *after = NULL;
  int count = 0;
  for (const char *at = text; count < 3; at = after + 1) {
    value[count] = hl_plain_number(at, &after);
    if (after == at || after > end || !isfinite(value[count])) return 0;
    count++;
    if (after == end || *after != ',') break;
  }
  return after == end && count != 2 ? count : 0;
}

/* Reads numbers, or a colour as #rrggbb or a CSS name. Returns the number of components, 1 or 3; 0 if the
 * text has another form. */
static int read_value(const char *text, const char *end, double value[3], bool *is_color) {
  char color[64];
  const int count = read_numbers(text, end, value);
  *is_color = false;
  if (count > 0) return count;
  if (end - text >= (int)sizeof color) return 0;
  snprintf(color, sizeof color, "%.*s", (int)(end - text), text);
  *is_color = hl_parse_color(color, 0, 1, value);
  return *is_color ? 3 : 0;
}

/* Returns the end of the value that begins at `text`: the comma before the next FRAME:, or, if no FRAME:
 * follows, a comma that ends the text or the end of the text itself. */
static const char *end_of_value(const char *text) {
  const char *colon = strchr(text, ':'), *end = colon != NULL ? colon : text + strlen(text);
  const char *comma = memrchr(text, ',', (size_t)(end - text));
  if (comma != NULL && (colon != NULL || comma[1] == '\0')) return comma;
  return colon != NULL ? text + strcspn(text, ",") : end;
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

/* Reads "FRAME:VALUE" at *at, and moves *at behind this text. The first point of a key sets the key's number
 * of components. */
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
  end = end_of_value(text);
  length = (int)(end - *at);
  double value[3] = {0};
  bool is_color;
  int components = read_value(text, end, value, &is_color);
  if (components == 0)
    return refuse(error,
                  "%s: '%.*s' has no finite number after its frame, no three as X,Y,Z, and no colour "
                  "(#rrggbb or a CSS name)",
                  key->path, length, *at);
  if (key->count > 0 && (components != key->components || is_color != key->is_color))
    return refuse(error, "%s: '%.*s': a key has either numbers, or three each time, or colours", key->path,
                  length, *at);
  key->components = components;
  key->is_color = is_color;
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
  size_t most = 0; /* each point has a colon */
  for (const char *c = equals; *c != '\0'; c++) most += *c == ':';
  if (most > FILM_MOST_POINTS) return refuse(error, "more than %d points", (int)FILM_MOST_POINTS);
  key->path = strndup(text, (size_t)(equals - text));
  key->frames = calloc(most + 1, sizeof *key->frames);
  key->values = calloc(3 * (most + 1), sizeof *key->values);
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

/* Returns the fraction of the change from point p - 1 to point p that is reached at a frame between these
 * points. */
static double part_at(const film_key *key, size_t p, int frame) {
  double span = key->frames[p] - key->frames[p - 1], part = (frame - key->frames[p - 1]) / span;
  /* Hermite's cubic from 0 to 1, whose slope is 0 at both ends */
  return key->smooth ? part * part * (3 - 2 * part) : part;
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Finds the unit vector at right angles to `from` towards which a direction turns on its way to `to`. If
 * the directions are opposite, so that all ways are equally long, any such vector is returned. Returns
 * false if no such vector can be found. from: a unit vector. */
static bool find_side(const double from[3], const double to[3], double side[3]) {
  double other[3] = {to[0], to[1], to[2]};
  for (int attempt = 0; attempt < 2; attempt++) {
    const double along = dot(from, other);
    for (int k = 0; k < 3; k++) side[k] = other[k] - along * from[k];
    const double length = sqrt(dot(side, side));
    for (int k = 0; k < 3 && length > 1e-9; k++) side[k] /= length;
    if (length > 1e-9) return true;
    if (along >= 0) return false;
    const int least = fabs(from[0]) < 0.6 ? 0 : fabs(from[1]) < 0.6 ? 1 : 2;
    for (int k = 0; k < 3; k++) other[k] = k == least;
  }
  return false;
}

/* Finds a direction on the great circle from direction a to direction b. The result's length lies between
 * the lengths of a and b. Returns false if the directions are the same, or if one of them has no length.
 * The result must then be on the line between them. */
static bool turn_between(const double a[3], const double b[3], double part, double between[3]) {
  const double lengths[2] = {sqrt(dot(a, a)), sqrt(dot(b, b))};
  double from[3], to[3], side[3];
  if (!(lengths[0] > 0 && lengths[1] > 0)) return false;
  for (int k = 0; k < 3; k++) from[k] = a[k] / lengths[0], to[k] = b[k] / lengths[1];
  if (!find_side(from, to, side)) return false;
  const double angle = part * hl_atan2(dot(to, side), dot(to, from));
  const double length = lengths[0] + (lengths[1] - lengths[0]) * part;
  for (int k = 0; k < 3; k++) between[k] = length * (from[k] * hl_cos(angle) + side[k] * hl_sin(angle));
  return true;
}

void film_key_value(const film_key *key, int frame, double value[3]) {
  const size_t size = (size_t)key->components;
  size_t p = 0;
  while (p < key->count && key->frames[p] < frame) p++;
  const bool is_given = p == 0 || p == key->count || key->frames[p] == frame;
  const double *after = key->values + (p == key->count ? p - 1 : p) * size;
  memset(value, 0, 3 * sizeof *value);
  memcpy(value, after, size * sizeof *value); /* exactly the given value, without rounding */
  if (is_given) return;
  const double *before = after - size, part = part_at(key, p, frame);
  if (key->turns && turn_between(before, after, part, value)) return;
  for (size_t k = 0; k < size; k++) value[k] = before[k] + (after[k] - before[k]) * part;
}
