/* cli/json_writer.h - writes JSON to stdout, indented by two blanks.
 *
 * Calls nest: an object or array opened is closed by json_close(). `key` names the value inside an object and
 * is null inside an array. */
#ifndef HL_CLI_JSON_WRITER_H
#define HL_CLI_JSON_WRITER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct json_writer {
  int depth;
  bool first;     /* whether the innermost open object or array is still empty */
  char close[16]; /* closing bracket of each level */
} json_writer;

void json_open_object(json_writer *writer, const char *key);
void json_open_array(json_writer *writer, const char *key);
void json_close(json_writer *writer);

void json_text(json_writer *writer, const char *key, const char *value); /* null becomes null */
void json_bool(json_writer *writer, const char *key, bool value);
void json_whole_number(json_writer *writer, const char *key, uint64_t value);
void json_signed_number(json_writer *writer, const char *key, int64_t value);
/* A number that is not finite becomes null. */
void json_number(json_writer *writer, const char *key, double value);
/* One line: [a, b, c] */
void json_numbers(json_writer *writer, const char *key, const double *values, size_t count);
/* Writes a value that is JSON text already. */
void json_written(json_writer *writer, const char *key, const char *value);
void json_whole_numbers(json_writer *writer, const char *key, const uint64_t *values, size_t count);

#endif
