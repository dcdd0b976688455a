/* film/keys.c - reads keys, and finds their values at a frame. */
#define _GNU_SOURCE
#include "keys.h"
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

/* Reads "FRAME:VALUE" at *at, and moves *at past it. */
static hl_status read_point(const char **at, const film_key *key, int *frame, double *value,
                            hl_error *error) {
  char *end;
  int length = (int)strcspn(*at, ",");
  long number = strtol(*at, &end, 10);
  if (**at < '0' || **at > '9' || *end != ':' || number > FILM_MOST_FRAMES)
    return refuse(error, "%s: '%.*s' is no FRAME:VALUE: frames are counted from 0, as in 0:10,48:35",
                  key->path, length, *at);
  const char *text = end + 1;
  *frame = (int)number;
  *value = hl_plain_number(text, &end);
  if (end == text || (*end != ',' && *end != '\0') || !isfinite(*value))
    return refuse(error, "%s: '%.*s' has no finite number after its frame", key->path, length, *at);
  if (key->count > 0 && *frame <= key->frames[key->count - 1])
    return refuse(error, "%s: frame %d does not come after frame %d", key->path, *frame,
                  key->frames[key->count - 1]);
  *at = *end == ',' ? end + 1 : end;
  return *end == ',' && **at == '\0' ? refuse(error, "%s: nothing follows the last comma", key->path) : HL_OK;
}

hl_status film_key_read(const char *text, film_key *key, hl_error *error) {
  *key = (film_key){0};
  const char *equals = strchr(text, '=');
  if (equals == NULL || equals == text || equals[1] == '\0')
    return refuse(error, "'%s' is no PATH=FRAME:VALUE,...: write it as lights.0.intensity=0:1,48:2", text);
  size_t most = 1;
  for (const char *c = equals; *c != '\0'; c++) most += *c == ',';
  if (most > FILM_MOST_POINTS) return refuse(error, "more than %d points", (int)FILM_MOST_POINTS);
  key->path = strndup(text, (size_t)(equals - text));
  key->frames = calloc(most, sizeof *key->frames);
  key->values = calloc(most, sizeof *key->values);
  if (key->path == NULL || key->frames == NULL || key->values == NULL) {
    refuse(error, "out of memory for keys");
    return HL_ERROR_MEMORY;
  }
  const char *at = equals + 1;
  hl_status status = HL_OK;
  while (status == HL_OK && *at != '\0') {
    status = read_point(&at, key, &key->frames[key->count], &key->values[key->count], error);
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

double film_key_value(const film_key *key, int frame) {
  if (frame <= key->frames[0]) return key->values[0];
  for (size_t p = 1; p < key->count; p++) {
    if (frame > key->frames[p]) continue;
    double span = key->frames[p] - key->frames[p - 1], past = frame - key->frames[p - 1];
    if (frame == key->frames[p]) return key->values[p]; /* returns exactly the given value */
    double part = past / span;
    if (key->smooth) part = part * part * (3 - 2 * part); /* Hermite: no speed at both ends */
    return key->values[p - 1] + (key->values[p] - key->values[p - 1]) * part;
  }
  return key->values[key->count - 1];
}
