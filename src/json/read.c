/* json/read.c - gives tools to strict readers of JSON. */
#include "json/read.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "text/edit_distance.h"
#include "text/plain.h"
#include "text/plain_json.h"

json_t *hl_json_copy(const json_t *value) {
  json_t *copy = json_copy((json_t *)value);
  if (json_object_size(copy) == json_object_size(value))
    return copy; /* without memory, jansson leaves members out */
  json_decref(copy);
  return NULL;
}

/* The advice for mistakes that are often made in JSON text. */
static const char *mend_of_fault(const char *fault) {
  static const struct {
    const char *near, *mend;
  } mends[] = {
      {"near '/'", ": JSON has no comments, remove them"},
      {"near '//", ": JSON has no comments, remove them"},
      {"near 'NaN'", ": JSON has no NaN, give a number"},
      {"near 'Infinity'", ": JSON has no infinity, give a number"},
      {"overflow", ": give a number that a double holds"},
      {"duplicate object key", ": remove one of the two"},
  };
  for (size_t m = 0; m < sizeof mends / sizeof *mends; m++)
    if (strstr(fault, mends[m].near) != NULL) return mends[m].mend;
  return "";
}

/* Skips a byte-order mark of UTF-8, which some Windows programs write; refuses text in UTF-16. */
static hl_status pass_byte_order_mark(const char **text, size_t *length, const char *name, hl_error *error) {
  if (*length >= 2 && (memcmp(*text, "\xff\xfe", 2) == 0 || memcmp(*text, "\xfe\xff", 2) == 0))
    return hl_fail_at(error, HL_ERROR_INPUT, 1, 1, "%s:1:1: UTF-16 text: save it as UTF-8", name);
  if (*length < 3 || memcmp(*text, "\xef\xbb\xbf", 3) != 0) return HL_OK;
  *text += 3;
  *length -= 3;
  return HL_OK;
}

hl_status hl_json_parse(const char *text, size_t length, const char *name, json_t **root, hl_error *error) {
  json_error_t fault;
  if (length > HL_JSON_LIMIT)
    return hl_fail(error, HL_ERROR_INPUT, "%s: %zu bytes are too many for a scene: at most %zu are read",
                   name, length, HL_JSON_LIMIT);
  hl_status status = pass_byte_order_mark(&text, &length, name, error);
  if (status != HL_OK) return status;
  *root = hl_plain_json_load(text, length, JSON_REJECT_DUPLICATES, &fault);
  if (*root != NULL) return HL_OK;
  /* jansson states neither a reason nor a line if it has no memory for its first buffer */
  if (json_error_code(&fault) == json_error_out_of_memory || fault.line < 1)
    return hl_fail_memory(error, length, name);
  return hl_fail_at(error, HL_ERROR_INPUT, fault.line, fault.column, "%s:%d:%d: %s%s", name, fault.line,
                    fault.column, fault.text, mend_of_fault(fault.text));
}

hl_status hl_json_fail(hl_json_reader *reader, hl_status code, const char *key, const char *format, ...) {
  char text[700];
  va_list arguments;
  va_start(arguments, format);
  hl_plain_vprint(text, sizeof text, format, arguments);
  va_end(arguments);
  const char *place = key == NULL && reader->place[0] == 0 ? "/" : reader->place;
  return hl_fail(reader->error, code, "%s: %s%s%s: %s", reader->name, place, key != NULL ? "/" : "",
                 key != NULL ? key : "", text);
}

hl_status hl_json_prefix(hl_json_reader *reader, const char *place) {
  hl_error *error = reader->error;
  if (error == NULL) return HL_OK;
  char text[sizeof error->message];
  memcpy(text, error->message, sizeof text);
  int used = snprintf(error->message, sizeof error->message, "%s: %s%s", reader->name,
                      place != NULL ? place : "", place != NULL ? ": " : "");
  if (used > 0 && (size_t)used < sizeof error->message)
    snprintf(error->message + used, sizeof error->message - (size_t)used, "%s", text);
  return error->code;
}

size_t hl_json_enter(hl_json_reader *reader, const char *key) {
  size_t mark = strlen(reader->place);
  snprintf(reader->place + mark, sizeof reader->place - mark, "/%s", key);
  return mark;
}

size_t hl_json_enter_index(hl_json_reader *reader, size_t index) {
  char text[24];
  snprintf(text, sizeof text, "%zu", index);
  return hl_json_enter(reader, text);
}

void hl_json_leave(hl_json_reader *reader, size_t mark) { reader->place[mark] = 0; }

const char *hl_json_type_name(const json_t *value) {
  switch (json_typeof(value)) {
    case JSON_OBJECT: return "an object";
    case JSON_ARRAY: return "an array";
    case JSON_STRING: return "a string";
    case JSON_INTEGER: return "an integer";
    case JSON_REAL: return "a number";
    case JSON_TRUE: return "true";
    case JSON_FALSE: return "false";
    case JSON_NULL: return "null";
  }
  return "something unknown";
}

static bool listed(const char *const *names, const char *name) {
  while (*names != NULL && strcmp(*names, name) != 0) names++;
  return *names != NULL;
}

hl_status hl_json_object(hl_json_reader *reader, const json_t *value, const char *const *keys) {
  if (!json_is_object(value))
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "is %s: give an object, { ... }",
                        hl_json_type_name(value));
  const char *key;
  json_t *member;
  json_object_foreach((json_t *)value, key, member) {
    if (listed(keys, key)) continue;
    char mend[400], shown[84];
    hl_suggest_name(key, keys, mend, sizeof mend);
    snprintf(shown, sizeof shown, "%.80s", key);
    return hl_json_fail(reader, HL_ERROR_INPUT, shown, "unknown key: %s", mend);
  }
  return HL_OK;
}

hl_status hl_json_array(hl_json_reader *reader, const json_t *value, size_t least, size_t most) {
  if (!json_is_array(value))
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "is %s: give an array, [ ... ]",
                        hl_json_type_name(value));
  size_t count = json_array_size(value);
  if (count >= least && count <= most) return HL_OK;
  if (least == most)
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "has %zu elements: give %zu", count, least);
  return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "has %zu elements: give %zu to %zu", count, least, most);
}

hl_status hl_json_number(hl_json_reader *reader, const json_t *object, const char *key, double *number) {
  const json_t *value = json_object_get(object, key);
  if (value == NULL) return HL_OK;
  if (!json_is_number(value))
    return hl_json_fail(reader, HL_ERROR_INPUT, key, "is %s: give a number", hl_json_type_name(value));
  *number = json_number_value(value);
  return HL_OK;
}

hl_status hl_json_integer(hl_json_reader *reader, const json_t *object, const char *key, int *number) {
  const json_t *value = json_object_get(object, key);
  if (value == NULL) return HL_OK;
  if (!json_is_integer(value))
    return hl_json_fail(reader, HL_ERROR_INPUT, key, "is %s: give a whole number", hl_json_type_name(value));
  json_int_t integer = json_integer_value(value);
  if (integer < -1000000000 || integer > 1000000000)
    return hl_json_fail(reader, HL_ERROR_INPUT, key, "%lld is out of range: give a smaller number",
                        (long long)integer);
  *number = (int)integer;
  return HL_OK;
}

hl_status hl_json_flag(hl_json_reader *reader, const json_t *object, const char *key, int *flag) {
  const json_t *value = json_object_get(object, key);
  if (value == NULL) return HL_OK;
  if (!json_is_boolean(value))
    return hl_json_fail(reader, HL_ERROR_INPUT, key, "is %s: give true or false", hl_json_type_name(value));
  *flag = json_is_true(value);
  return HL_OK;
}

hl_status hl_json_text(hl_json_reader *reader, const json_t *object, const char *key, const char **text) {
  const json_t *value = json_object_get(object, key);
  if (value == NULL) return HL_OK;
  if (!json_is_string(value))
    return hl_json_fail(reader, HL_ERROR_INPUT, key, "is %s: give a string", hl_json_type_name(value));
  *text = json_string_value(value);
  return HL_OK;
}

hl_status hl_json_choice(hl_json_reader *reader, const json_t *object, const char *key,
                         const char *const *names, int first, int *choice) {
  const char *name = NULL;
  hl_status status = hl_json_text(reader, object, key, &name);
  if (status != HL_OK || name == NULL) return status;
  for (int n = 0; names[n] != NULL; n++)
    if (strcmp(names[n], name) == 0) {
      *choice = first + n;
      return HL_OK;
    }
  char mend[400];
  hl_suggest_name(name, names, mend, sizeof mend);
  return hl_json_fail(reader, HL_ERROR_INPUT, key, "\"%.80s\" is no known choice: %s", name, mend);
}

hl_status hl_json_row(hl_json_reader *reader, const json_t *value, const char *key, size_t count,
                      double *numbers) {
  size_t mark = hl_json_enter(reader, key);
  hl_status status = hl_json_array(reader, value, count, count);
  for (size_t n = 0; status == HL_OK && n < count; n++) {
    const json_t *element = json_array_get(value, n);
    char index[24];
    snprintf(index, sizeof index, "%zu", n);
    if (json_is_number(element)) numbers[n] = json_number_value(element);
    else
      status = hl_json_fail(reader, HL_ERROR_INPUT, index, "is %s: give a number",
                            hl_json_type_name(element));
  }
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

hl_status hl_json_numbers(hl_json_reader *reader, const json_t *object, const char *key, size_t count,
                          double *numbers) {
  const json_t *value = json_object_get(object, key);
  return value == NULL ? HL_OK : hl_json_row(reader, value, key, count, numbers);
}
