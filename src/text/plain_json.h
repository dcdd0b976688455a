/* text/plain_json.h - calls jansson's readers and writers in the locale "C". In the host's locale, jansson
 * would use the locale's decimal point, and could not handle a decimal point that is longer than a byte. */
#ifndef HL_TEXT_PLAIN_JSON_H
#define HL_TEXT_PLAIN_JSON_H

#include <jansson.h>
#include <stddef.h>

/* Functions that do the work of json_loadb(), json_loads() (without flags and error) and json_dumps() in the
 * locale "C". */
json_t *hl_plain_json_load(const char *text, size_t length, size_t flags, json_error_t *error);
json_t *hl_plain_json_load_text(const char *text);
char *hl_plain_json_dump(const json_t *json, size_t flags);

#endif
