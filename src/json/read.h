/* json/read.h - reads JSON strictly: it requires values of the right type, refuses unknown keys, and names
 * the place of each error.
 *
 * A reader keeps its place in the text as a JSON pointer. If a key is absent, getters do not change their
 * target. The caller sets targets to their defaults first. Every getter returns a status, and the caller
 * stops at the first error. */
#ifndef HL_JSON_READ_H
#define HL_JSON_READ_H

#include <jansson.h>
#include <stdbool.h>

#include "core/error.h"

#include <halflight/scene.h>

#define HL_JSON_LIMIT ((size_t)16 << 20) /* greatest number of bytes of one JSON text */

typedef struct hl_json_reader {
  hl_context *context;
  const char *name;   /* the text's name in errors */
  const char *folder; /* the folder to which relative paths refer; may be null */
  hl_error *error;
  const hl_scene_description *like; /* if it is not null, the reader opens no file, and takes volumes and
                                     * images from this scene */
  int preview_pixels;               /* see hl_scene_load_coarse(); 0 if volumes are read as the scene says */
  char place[400];                  /* JSON pointer of the value that is being read */
} hl_json_reader;

/* Parses a text. *root is owned by the caller (json_decref); a syntax error gives NAME:LINE:COLUMN. */
hl_status hl_json_parse(const char *text, size_t length, const char *name, json_t **root, hl_error *error);

/* A copy of a JSON object. The copy shares all members with the original. Null if memory is short. */
json_t *hl_json_copy(const json_t *value);

/* Fails with "NAME: PLACE/KEY: ...". If key is null, the line is "NAME: PLACE: ...". */
__attribute__((format(printf, 4, 5))) hl_status hl_json_fail(hl_json_reader *reader, hl_status code,
                                                             const char *key, const char *format, ...);
/* Puts "NAME: " before the error's message, followed by "PLACE: " if place is not null. Returns the error's
 * code. */
hl_status hl_json_prefix(hl_json_reader *reader, const char *place);

/* The name of a value's type with its article: "an object", "a string" and so on. */
const char *hl_json_type_name(const json_t *value);

/* Two functions that enter a member of an object or an element of an array. Each of them appends the key or
 * the number to the reader's place. Returns the mark that hl_json_leave() takes. */
size_t hl_json_enter(hl_json_reader *reader, const char *key);
size_t hl_json_enter_index(hl_json_reader *reader, size_t index);
void hl_json_leave(hl_json_reader *reader, size_t mark);

/* Checks that a value is an object whose keys are all in a list, which null ends. */
hl_status hl_json_object(hl_json_reader *reader, const json_t *value, const char *const *keys);
/* Checks that a value is an array with at least `least` and at most `most` elements. */
hl_status hl_json_array(hl_json_reader *reader, const json_t *value, size_t least, size_t most);

hl_status hl_json_number(hl_json_reader *reader, const json_t *object, const char *key, double *number);
hl_status hl_json_integer(hl_json_reader *reader, const json_t *object, const char *key, int *number);
hl_status hl_json_flag(hl_json_reader *reader, const json_t *object, const char *key, int *flag);
hl_status hl_json_text(hl_json_reader *reader, const json_t *object, const char *key, const char **text);
/* Reads a text that must be one of `names`, a list that ends with null. *choice becomes the index of the text
 * in this list, plus `first`. */
hl_status hl_json_choice(hl_json_reader *reader, const json_t *object, const char *key,
                         const char *const *names, int first, int *choice);
/* Reads a value that must be an array of exactly `count` numbers. key: the value's name in errors. */
hl_status hl_json_row(hl_json_reader *reader, const json_t *value, const char *key, size_t count,
                      double *numbers);
/* Reads a member that is an array of exactly `count` numbers. If the member is absent, nothing is read. */
hl_status hl_json_numbers(hl_json_reader *reader, const json_t *object, const char *key, size_t count,
                          double *numbers);

#endif
