/* json/isosurfaces.c - reads the isosurfaces of a volume from JSON. */
#include "core/memory.h"
#include "json/parts.h"
#include "json/settings.h"

static hl_status read_surface(hl_json_reader *reader, const json_t *value, hl_isosurface *surface) {
  hl_isosurface_defaults(surface);
  hl_status status = hl_json_settings_object(reader, value, HL_SETTINGS_ISO, -1, NULL);
  if (status == HL_OK && json_object_get(value, "value") == NULL)
    status = hl_json_fail(reader, HL_ERROR_INPUT, "value", "is missing: give the value on the surface");
  return status == HL_OK ? hl_json_settings(reader, value, HL_SETTINGS_ISO, 0, surface) : status;
}

hl_status hl_json_read_iso(hl_json_reader *reader, const json_t *value, hl_scene_volume *volume) {
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "iso"), count = json_array_size(value);
  hl_status status = hl_json_array(reader, value, 0, HL_LIMIT_ISO);
  if (status != HL_OK) return status;
  hl_isosurface *surfaces = hl_allocate_zeroed(reader->context, count, sizeof *surfaces);
  if (surfaces == NULL) return hl_fail_memory(reader->error, count * sizeof *surfaces, "isosurfaces");
  volume->iso = surfaces;
  volume->iso_count = count;
  for (size_t i = 0; i < count; i++) {
    size_t inner = hl_json_enter_index(reader, i);
    if ((status = read_surface(reader, json_array_get(value, i), &surfaces[i])) != HL_OK) return status;
    hl_json_leave(reader, inner);
  }
  hl_json_leave(reader, mark);
  return HL_OK;
}
