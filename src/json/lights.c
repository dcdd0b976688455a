/* json/lights.c - lights from JSON, with the images that they project or show themselves. */
#include <stdio.h>
#include <string.h>

#include <halflight/image.h>

#include "core/file.h"
#include "core/memory.h"
#include "json/parts.h"
#include "json/settings.h"
#include "scene/check.h"
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

/* The fields that an image is loaded into: a light texture's or an emission image's. */
typedef struct light_emission {
  const char **file;
  const float **pixels;
  int *width, *height;
} light_emission;

/* Whether an image of `like` was read from this file; *pixels are a copy, owned by the caller. */
static hl_status copy_known(hl_json_reader *reader, const char *path, const light_emission *to, bool *found) {
  *found = false;
  for (size_t l = 0; l < reader->like->light_count; l++) {
    const hl_light *light = &reader->like->lights[l];
    const hl_light_texture *texture = &light->texture;
    const hl_light_emission *emission = &light->emission;
    bool projected = texture->file != NULL && strcmp(texture->file, path) == 0;
    if (!projected && (emission->file == NULL || strcmp(emission->file, path) != 0)) continue;
    *to->width = projected ? texture->width : emission->width;
    *to->height = projected ? texture->height : emission->height;
    size_t count = 3 * (size_t)*to->width * (size_t)*to->height;
    float *pixels = hl_allocate(reader->context, count, sizeof *pixels);
    if (pixels == NULL) return hl_fail_memory(reader->error, count * sizeof *pixels, "a light's image");
    memcpy(pixels, projected ? texture->pixels : emission->pixels, count * sizeof *pixels);
    *to->pixels = pixels;
    *found = true;
    return HL_OK;
  }
  return HL_OK;
}

/* Copies an image's colours without alpha: premultiplied, they are the image over black. */
static hl_status take_pixels(hl_context *context, const hl_image *image, const light_emission *to,
                             hl_error *error) {
  size_t count = (size_t)hl_image_width(image) * (size_t)hl_image_height(image);
  const float *from = hl_image_pixels_const(image);
  float *pixels = hl_allocate(context, count, 3 * sizeof *pixels);
  if (pixels == NULL) return hl_fail_memory(error, count * 3 * sizeof *pixels, "a light's image");
  for (size_t i = 0; i < count; i++)
    for (size_t c = 0; c < 3; c++) pixels[3 * i + c] = from[4 * i + c];
  *to->pixels = pixels;
  *to->width = hl_image_width(image);
  *to->height = hl_image_height(image);
  return HL_OK;
}

/* Loads the image that an object's "file" names. */
static hl_status load(hl_json_reader *reader, const json_t *value, const light_emission *to) {
  const char *file = NULL;
  hl_status status = hl_json_text(reader, value, "file", &file);
  if (status != HL_OK) return status;
  if (file == NULL || file[0] == 0)
    return hl_json_fail(reader, HL_ERROR_INPUT, "file", "%s: name the image's file",
                        file == NULL ? "is missing" : "is empty");
  char *path = hl_path_join(reader->context, reader->folder, file);
  if (path == NULL) return hl_fail_memory(reader->error, strlen(file) + 1, "a path");
  *to->file = path;
  if (reader->like != NULL) {
    bool found;
    status = copy_known(reader, path, to, &found);
    if (status != HL_OK || found) return status;
    return hl_json_fail(reader, HL_ERROR_INPUT, "file",
                        "\"%.200s\" is no image of the open scene: open it anew", file);
  }
  hl_image *image = NULL;
  status = hl_image_read(reader->context, path, &image, reader->error);
  if (status == HL_OK) status = take_pixels(reader->context, image, to, reader->error);
  hl_image_destroy(image);
  if (status == HL_OK) return HL_OK;
  hl_json_enter(reader, "file");
  return hl_json_prefix(reader, reader->place), status;
}

hl_status hl_json_read_texture(hl_json_reader *reader, const json_t *value, hl_light_texture *texture) {
  static const char *const keys[] = {"file", "screen", NULL};
  const light_emission image = {&texture->file, &texture->pixels, &texture->width, &texture->height};
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "texture");
  hl_status status = hl_json_object(reader, value, keys);
  if (status == HL_OK) status = read_screen(reader, json_object_get(value, "screen"), texture);
  if (status == HL_OK) status = load(reader, value, &image);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

hl_status hl_json_read_emission(hl_json_reader *reader, const json_t *value, hl_light_type type,
                                hl_light_emission *emission) {
  static const char *const keys[] = {"file", "up", NULL}, *const rect_keys[] = {"file", NULL};
  const light_emission image = {&emission->file, &emission->pixels, &emission->width, &emission->height};
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "emission");
  hl_status status = hl_json_object(reader, value, type == HL_LIGHT_RECT ? rect_keys : keys);
  if (status == HL_OK) status = hl_json_numbers(reader, value, "up", 3, emission->up);
  if (status == HL_OK) status = load(reader, value, &image);
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

/* Where the scene gives no width of a spot light's edge, the default is cut to what fits into its cone. */
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
  const bool polygon = light->type == HL_LIGHT_POLYGON;
  if (status == HL_OK)
    status = hl_json_settings_object(reader, value, HL_SETTINGS_LIGHT, (int)light->type,
                                     others + (polygon ? 0 : 1));
  if (status == HL_OK) status = hl_json_settings(reader, value, HL_SETTINGS_LIGHT, (int)light->type, light);
  narrow_edge(value, light);
  if (status == HL_OK && polygon) status = read_vertices(reader, value, light);
  if (status == HL_OK)
    status = hl_json_read_texture(reader, json_object_get(value, "texture"), &light->texture);
  if (status == HL_OK)
    status = hl_json_read_emission(reader, json_object_get(value, "emission"), light->type, &light->emission);
  return status;
}
