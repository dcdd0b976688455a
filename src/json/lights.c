/* json/lights.c - lights from JSON, with the images that they project or show themselves. */
#include <stdio.h>
#include <string.h>

#include <halflight/image.h>

#include "core/file.h"
#include "core/memory.h"
#include "json/parts.h"
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

/* Where an image goes. */
typedef struct light_image {
  const char **file;
  const float **pixels;
  int *width, *height;
} light_image;

/* Premultiplied colours are those over black: alpha is left out. */
static hl_status take_pixels(hl_context *context, const hl_image *image, const light_image *to,
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

/* The image that an object's "file" names. */
static hl_status load(hl_json_reader *reader, const json_t *value, const light_image *to) {
  const char *file = NULL;
  hl_status status = hl_json_text(reader, value, "file", &file);
  if (status != HL_OK) return status;
  if (file == NULL || file[0] == 0)
    return hl_json_fail(reader, HL_ERROR_INPUT, "file", "%s: name the image's file",
                        file == NULL ? "is missing" : "is empty");
  char *path = hl_path_join(reader->context, reader->folder, file);
  if (path == NULL) return hl_fail_memory(reader->error, strlen(file) + 1, "a path");
  *to->file = path;
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
  const light_image image = {&texture->file, &texture->pixels, &texture->width, &texture->height};
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
  const light_image image = {&emission->file, &emission->pixels, &emission->width, &emission->height};
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "emission");
  hl_status status = hl_json_object(reader, value, type == HL_LIGHT_RECT ? rect_keys : keys);
  if (status == HL_OK) status = hl_json_numbers(reader, value, "up", 3, emission->up);
  if (status == HL_OK) status = load(reader, value, &image);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

/* ---- lights ---- */

/* What each type of light may say, in the order of hl_light_type. */
#define COMMON_KEYS "frame", "color", "intensity", "falloff", "shadows", "texture", "emission", NULL
static const char *const directional_keys[] = {"type", "direction", "angular_diameter_deg", COMMON_KEYS};
static const char *const point_keys[] = {"type", "position", "radius", COMMON_KEYS};
static const char *const spot_keys[] = {
    "type", "position", "direction", "opening_angle_deg", "falloff_angle_deg", "radius", COMMON_KEYS};
static const char *const rect_keys[] = {"type", "position", "edge1", "edge2", COMMON_KEYS};
static const char *const disk_keys[] = {"type", "position", "normal", "radius", COMMON_KEYS};
static const char *const polygon_keys[] = {"type", "vertices", COMMON_KEYS};
static const char *const *const light_keys[] = {directional_keys, point_keys, spot_keys,
                                                rect_keys,        disk_keys,  polygon_keys};

/* The vertices in memory of the light's own. */
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

/* Without a word on it the edge is as wide as a narrow cone allows. */
static hl_status read_cone(hl_json_reader *reader, const json_t *value, hl_light *light) {
  hl_status status = hl_json_number(reader, value, "opening_angle_deg", &light->opening_angle_deg);
  if (light->falloff_angle_deg > light->opening_angle_deg / 2)
    light->falloff_angle_deg = light->opening_angle_deg / 2;
  return status == HL_OK ? hl_json_number(reader, value, "falloff_angle_deg", &light->falloff_angle_deg)
                         : status;
}

static hl_status read_light_place(hl_json_reader *reader, const json_t *value, hl_light *light) {
  hl_status status = hl_json_numbers(reader, value, "direction", 3, light->direction);
  if (status == HL_OK)
    status = hl_json_number(reader, value, "angular_diameter_deg", &light->angular_diameter_deg);
  if (status == HL_OK) status = hl_json_numbers(reader, value, "position", 3, light->position);
  if (status == HL_OK) status = hl_json_number(reader, value, "radius", &light->radius);
  if (status == HL_OK) status = read_cone(reader, value, light);
  if (status == HL_OK) status = hl_json_numbers(reader, value, "normal", 3, light->normal);
  if (status == HL_OK) status = hl_json_numbers(reader, value, "edge1", 3, light->edge1);
  if (status == HL_OK) status = hl_json_numbers(reader, value, "edge2", 3, light->edge2);
  return status == HL_OK && light->type == HL_LIGHT_POLYGON ? read_vertices(reader, value, light) : status;
}

hl_status hl_json_read_light(hl_json_reader *reader, const json_t *value, hl_light *light) {
  static const char *const all[] = {"type",
                                    "direction",
                                    "angular_diameter_deg",
                                    "position",
                                    "radius",
                                    "normal",
                                    "edge1",
                                    "edge2",
                                    "opening_angle_deg",
                                    "falloff_angle_deg",
                                    "vertices",
                                    "frame",
                                    "color",
                                    "intensity",
                                    "falloff",
                                    "shadows",
                                    "texture",
                                    "emission",
                                    NULL};
  hl_light_defaults(light);
  int type = (int)light->type, frame = (int)light->frame, falloff = (int)light->falloff,
      shadows = (int)light->shadows;
  hl_status status = hl_json_object(reader, value, all);
  if (status == HL_OK) status = hl_json_choice(reader, value, "type", hl_light_type_names, 0, &type);
  if (status != HL_OK) return status;
  if ((status = hl_json_object(reader, value, light_keys[type])) != HL_OK) return status;
  light->type = (hl_light_type)type;
  status = hl_json_choice(reader, value, "frame", hl_light_frame_names, 0, &frame);
  light->frame = (hl_light_frame)frame;
  if (status == HL_OK) status = read_light_place(reader, value, light);
  if (status == HL_OK) status = hl_json_numbers(reader, value, "color", 3, light->color);
  if (status == HL_OK) status = hl_json_number(reader, value, "intensity", &light->intensity);
  if (status == HL_OK) status = hl_json_choice(reader, value, "falloff", hl_falloff_names, 0, &falloff);
  if (status == HL_OK)
    status = hl_json_choice(reader, value, "shadows", hl_shadows_names, HL_SHADOWS_OFF, &shadows);
  light->falloff = (hl_falloff)falloff;
  light->shadows = (hl_shadows)shadows;
  if (status == HL_OK)
    status = hl_json_read_texture(reader, json_object_get(value, "texture"), &light->texture);
  if (status == HL_OK)
    status = hl_json_read_emission(reader, json_object_get(value, "emission"), light->type, &light->emission);
  return status;
}
