/* scene/field_errors.c - writes how much the fields of a scene's volumes differ from their files.
 *
 * In: the volumes. Out: JSON, which pictures carry and which the program prints. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "scene/function/transfer_function.h"
#include "scene/scene.h"
#include "text/json_value.h"
#include "text/plain.h"

enum { OBJECT_BYTES = 4 * HL_JSON_NUMBER_BYTES + 200 };

static void write_number(double number, char text[HL_JSON_NUMBER_BYTES]) {
  if (isfinite(number)) hl_json_number_text(number, text);
  else strcpy(text, "null");
}

hl_status hl_field_errors_write(hl_context *context, const hl_scene_description *description, char **text,
                                hl_error *error) {
  hl_volume_field_error e = {.struct_size = sizeof e};
  size_t known = 0, used = 0;
  *text = NULL;
  for (size_t n = 0; n < description->volume_count; n++)
    known += hl_volume_get_field_error(description->volumes[n].volume, &e) == HL_OK;
  if (known == 0) return HL_OK;
  const size_t room = known * OBJECT_BYTES + 2;
  char *made = hl_allocate(context, room, 1);
  if (made == NULL) return hl_fail_memory(error, room, "the differences of fields");
  for (size_t n = 0; n < description->volume_count; n++) {
    const hl_transfer_function *function = &description->volumes[n].transfer_function;
    char value[HL_JSON_NUMBER_BYTES], of_range[HL_JSON_NUMBER_BYTES], opacity[HL_JSON_NUMBER_BYTES];
    if (hl_volume_get_field_error(description->volumes[n].volume, &e) != HL_OK) continue;
    write_number(e.value, value);
    write_number(e.of_range, of_range);
    write_number(hl_transfer_function_opacity_change(function, e.value), opacity);
    used += (size_t)hl_plain_print(
        made + used, room - used,
        "%s{\"volume\": %zu, \"value\": %s, \"of_range\": %s, \"opacity\": %s, \"kind\": \"%s\", "
        "\"source\": \"%s\"}",
        used == 0 ? "[" : ", ", n, value, of_range, opacity, e.kind, e.source);
  }
  strcpy(made + used, "]");
  *text = made;
  return HL_OK;
}
