/* json/read.h - strict reading of JSON: values of the right type, no unknown keys, errors that name the
 * place.
 *
 * A reader keeps its place in the text as a JSON pointer. Getters leave their target alone where the key is
 * absent: set targets to their defaults first. Every getter returns a status; stop at the first error. */
#ifndef HL_JSON_READ_H
#define HL_JSON_READ_H

#include <jansson.h>
#include <stdbool.h>

#include "core/error.h"

#include <halflight/scene.h>

#define HL_JSON_LIMIT ((size_t)16 << 20) /* bytes of one JSON text */

typedef struct hl_json_reader {
  hl_context *context;
  const char *name;   /* what errors call the text */
  const char *folder; /* where relative paths start; may be null */
  hl_error *error;
  const hl_scene_description
      *like;       /* no file is opened: volumes and images are those of this scene; or null */
  char place[400]; /* JSON pointer of the value being read */
} hl_json_reader;

/* Parses a text. *root is owned by the caller (json_decref); a syntax error gives NAME:LINE:COLUMN. */
hl_status hl_json_parse(const char *text, size_t length, const char *name, json_t **root, hl_error *error);

/* A copy of an object with all its members, which are shared, not copied; null without memory. */
json_t *hl_json_copy(const json_t *value);

/* Fails with "NAME: PLACE/KEY: ..."; key null: "NAME: PLACE: ...". */
__attribute__((format(printf, 4, 5))) hl_status hl_json_fail(hl_json_reader *reader, hl_status code,
                                                             const char *key, const char *format, ...);
/* Puts "NAME: ", and "PLACE: " if place is not null, before the error's message; returns the error's code. */
hl_status hl_json_prefix(hl_json_reader *reader, const char *place);

/* "an object", "a string", ... */
const char *hl_json_type_name(const json_t *value);

/* Enter a member or an element: add it to the place. Returns the mark for hl_json_leave(). */
size_t hl_json_enter(hl_json_reader *reader, const char *key);
size_t hl_json_enter_index(hl_json_reader *reader, size_t index);
void hl_json_leave(hl_json_reader *reader, size_t mark);

/* The value must be an object whose keys are all in the null-terminated list. */
hl_status hl_json_object(hl_json_reader *reader, const json_t *value, const char *const *keys);
/* The value must be an array of least to most elements. */
hl_status hl_json_array(hl_json_reader *reader, const json_t *value, size_t least, size_t most);

hl_status hl_json_number(hl_json_reader *reader, const json_t *object, const char *key, double *number);
hl_status hl_json_integer(hl_json_reader *reader, const json_t *object, const char *key, int *number);
hl_status hl_json_flag(hl_json_reader *reader, const json_t *object, const char *key, int *flag);
hl_status hl_json_text(hl_json_reader *reader, const json_t *object, const char *key, const char **text);
/* One of the null-terminated names; *choice gets its index plus first. */
hl_status hl_json_choice(hl_json_reader *reader, const json_t *object, const char *key,
                         const char *const *names, int first, int *choice);
/* The value, called key in errors, must be an array of exactly count numbers. */
hl_status hl_json_row(hl_json_reader *reader, const json_t *value, const char *key, size_t count,
                      double *numbers);
/* The same for a member, which may be absent. */
hl_status hl_json_numbers(hl_json_reader *reader, const json_t *object, const char *key, size_t count,
                          double *numbers);

#endif
