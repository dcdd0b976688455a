/* json/lights.c - reads lights from JSON, with the images that they project or show on their own surface. */
#include <stdio.h>
#include <string.h>

#include <halflight/image.h>

#include "core/file.h"
#include "core/memory.h"
#include "json/parts.h"
#include "json/settings.h"
#include "scene/check/check.h"
#include "scene/light/light_kind.h"
#include "scene/scene.h"

static hl_status read_screen(hl_json_reader *reader, const json_t *value, hl_light_texture *texture) {
  static const char *const keys[] = {"center", "right", "up", NULL};
  double *const parts[] = {texture->screen_center, texture->screen_right, texture->screen_up};
  if (value == NULL)
    return hl_json_fail(
        reader, HL_ERROR_INPUT, "screen",
        "is missing: say where the image stands, { \"center\": ..., \"right\": ..., \"up\": ... }");
  size_t mark = hl_json_enter(reader, "screen");
  hl_status status = hl_json_object(reader, value, keys);
  for (int k = 0; status == HL_OK && keys[k] != NULL; k++)
    if (json_object_get(value, keys[k]) == NULL)
      status = hl_json_fail(reader, HL_ERROR_INPUT, keys[k], "is missing: give center, right and up");
  for (int k = 0; status == HL_OK && keys[k] != NULL; k++)
    status = hl_json_numbers(reader, value, keys[k], 3, parts[k]);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

hl_status hl_json_read_texture(hl_json_reader *reader, const json_t *value, hl_light_texture *texture) {
  static const char *const keys[] = {"file", "screen", NULL};
  const hl_json_image image = {&texture->file, &texture->pixels, &texture->width, &texture->height, 3};
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "texture");
  hl_status status = hl_json_object(reader, value, keys);
  if (status == HL_OK) status = read_screen(reader, json_object_get(value, "screen"), texture);
  if (status == HL_OK) status = hl_json_load_image(reader, value, &image);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

hl_status hl_json_read_emission(hl_json_reader *reader, const json_t *value, bool has_edges,
                                hl_light_emission *emission) {
  static const char *const keys[] = {"file", "up", NULL}, *const rect_keys[] = {"file", NULL};
  const hl_json_image image = {&emission->file, &emission->pixels, &emission->width, &emission->height, 3};
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "emission");
  hl_status status = hl_json_object(reader, value, has_edges ? rect_keys : keys);
  if (status == HL_OK) status = hl_json_numbers(reader, value, "up", 3, emission->up);
  if (status == HL_OK) status = hl_json_load_image(reader, value, &image);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

/* ---- lights ---- */

/* Reads a polygon's vertices into memory owned by the light. */
static hl_status read_vertices(hl_json_reader *reader, const json_t *object, hl_light *light) {
  const json_t *value = json_object_get(object, "vertices");
  if (value == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "vertices",
                        "is missing: give three points or more, [ [x,y,z], ... ]");
  size_t mark = hl_json_enter(reader, "vertices");
  hl_status status = hl_json_array(reader, value, 3, HL_LIMIT_VERTICES);
  if (status != HL_OK) return status;
  size_t count = json_array_size(value);
  double(*vertices)[3] = hl_allocate(reader->context, count, sizeof *vertices);
  if (vertices == NULL) return hl_fail_memory(reader->error, count * sizeof *vertices, "a light's vertices");
  light->vertices = (const double(*)[3])vertices;
  light->vertex_count = count;
  for (size_t v = 0; v < count; v++) {
    char index[24];
    snprintf(index, sizeof index, "%zu", v);
    if ((status = hl_json_row(reader, json_array_get(value, v), index, 3, vertices[v])) != HL_OK)
      return status;
  }
  hl_json_leave(reader, mark);
  return HL_OK;
}

/* Reduces the width of a spot light's edge to the greatest width that fits into the light's cone, if the
 * scene gives no width. */
static void narrow_edge(const json_t *value, hl_light *light) {
  if (json_object_get(value, "falloff_angle_deg") == NULL &&
      light->falloff_angle_deg > light->opening_angle_deg / 2)
    light->falloff_angle_deg = light->opening_angle_deg / 2;
}

hl_status hl_json_read_light(hl_json_reader *reader, const json_t *value, hl_light *light) {
  static const char *const others[] = {"vertices", "texture", "emission", NULL};
  hl_light_defaults(light);
  hl_status status = hl_json_settings_object(reader, value, HL_SETTINGS_LIGHT, -1, others);
  if (status == HL_OK) status = hl_json_setting(reader, value, HL_SETTINGS_LIGHT, "type", light);
  if (status != HL_OK) return status;
  const light_kind *kind = hl_light_kind(light);
  if (status == HL_OK)
    status = hl_json_settings_object(reader, value, HL_SETTINGS_LIGHT, (int)light->type,
                                     others + (kind->outline ? 0 : 1));
  if (status == HL_OK) status = hl_json_settings(reader, value, HL_SETTINGS_LIGHT, (int)light->type, light);
  narrow_edge(value, light);
  if (status == HL_OK && kind->outline) status = read_vertices(reader, value, light);
  if (status == HL_OK)
    status = hl_json_read_texture(reader, json_object_get(value, "texture"), &light->texture);
  if (status == HL_OK)
    status = hl_json_read_emission(reader, json_object_get(value, "emission"), kind->parallelogram,
                                   &light->emission);
  return status;
}
