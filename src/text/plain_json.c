/* text/plain_json.c - see plain_json.h. */
#include "text/plain_json.h"

#include <string.h>

#include "text/plain.h"

json_t *hl_plain_json_load(const char *text, size_t length, size_t flags, json_error_t *error) {
  hl_plain_section section = hl_plain_begin();
  json_t *json = json_loadb(text, length, flags, error);
  hl_plain_end(section);
  return json;
}

json_t *hl_plain_json_load_text(const char *text) { return hl_plain_json_load(text, strlen(text), 0, NULL); }

char *hl_plain_json_dump(const json_t *json, size_t flags) {
  hl_plain_section section = hl_plain_begin();
  char *text = json_dumps(json, flags);
  hl_plain_end(section);
  return text;
}
