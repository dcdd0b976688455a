/* scene/json_view.c - camera, lights and render settings from JSON. */
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "scene/check.h"
#include "scene/json_parts.h"
#include "scene/scene.h"

static bool has(const json_t *object, const char *key) { return json_object_get(object, key) != NULL; }

/* A key that says nothing for this kind of thing would be ignored, so it is refused. */
static hl_status refuse_key(hl_json_reader *reader, const json_t *object, const char *key, const char *mend) {
  return has(object, key) ? hl_json_fail(reader, HL_ERROR_INPUT, key, "%s", mend) : HL_OK;
}

/* What the camera would be if the file said no more than its type and field of view. */
static hl_status frame(hl_json_reader *reader, const hl_scene_description *d, hl_camera *camera) {
  if (camera->type == HL_CAMERA_PERSPECTIVE && !(camera->fovy_deg >= 1e-6 && camera->fovy_deg <= 179.999))
    return hl_json_fail(reader, HL_ERROR_INPUT, "fovy_deg",
                        "%.9g is out of range: give an angle in degrees, above 0 and below 180",
                        camera->fovy_deg);
  hl_status status = hl_scene_frame(d, camera, reader->error);
  if (status == HL_OK || status == HL_ERROR_MEMORY || status == HL_ERROR_CANCELLED) return status;
  return hl_json_fail(reader, status, NULL, "the volumes cannot be framed: give a position and a target");
}

static hl_status read_camera_members(hl_json_reader *reader, const json_t *value, hl_scene_description *d) {
  static const char *const keys[] = {"type", "position", "target", "up", "fovy_deg", "height", NULL};
  hl_camera *camera = &d->camera;
  int type = (int)camera->type;
  hl_status status = hl_json_object(reader, value, keys);
  if (status == HL_OK) status = hl_json_choice(reader, value, "type", hl_camera_type_names, 0, &type);
  camera->type = (hl_camera_type)type;
  if (status == HL_OK && type == HL_CAMERA_PERSPECTIVE)
    status = refuse_key(reader, value, "height",
                        "is for orthographic cameras: give fovy_deg, or \"type\": \"orthographic\"");
  if (status == HL_OK && type == HL_CAMERA_ORTHOGRAPHIC)
    status = refuse_key(reader, value, "fovy_deg",
                        "is for perspective cameras: give height, or \"type\": \"perspective\"");
  if (status == HL_OK && !has(value, "position"))
    for (int k = 2; status == HL_OK && k < 4; k++)
      status = refuse_key(reader, value, keys[k],
                          "needs a position: give both, or neither to frame the volumes");
  if (status == HL_OK) status = hl_json_number(reader, value, "fovy_deg", &camera->fovy_deg);
  if (status == HL_OK) status = frame(reader, d, camera);
  if (status == HL_OK && has(value, "position")) memcpy(camera->up, (double[3]){0, 0, 1}, sizeof camera->up);
  if (status == HL_OK) status = hl_json_numbers(reader, value, "position", 3, camera->position);
  if (status == HL_OK) status = hl_json_numbers(reader, value, "target", 3, camera->target);
  if (status == HL_OK) status = hl_json_numbers(reader, value, "up", 3, camera->up);
  return status == HL_OK ? hl_json_number(reader, value, "height", &camera->height) : status;
}

hl_status hl_json_read_camera(hl_json_reader *reader, const json_t *value, hl_scene_description *d) {
  size_t mark = hl_json_enter(reader, "camera");
  hl_status status = value != NULL ? read_camera_members(reader, value, d) : frame(reader, d, &d->camera);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

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

static hl_status read_shadow_resolution(hl_json_reader *reader, const json_t *value, int *resolution) {
  const json_t *member = json_object_get(value, "shadow_resolution");
  if (json_is_string(member) && strcmp(json_string_value(member), "auto") == 0) {
    *resolution = 0;
    return HL_OK;
  }
  if (member == NULL) return HL_OK;
  if (json_is_integer(member) && json_integer_value(member) >= 1 &&
      json_integer_value(member) <= HL_LIMIT_SHADOW_RESOLUTION) {
    *resolution = (int)json_integer_value(member);
    return HL_OK;
  }
  return hl_json_fail(reader, HL_ERROR_INPUT, "shadow_resolution",
                      "give \"auto\" or a whole number of pixels from 1 to %d", HL_LIMIT_SHADOW_RESOLUTION);
}

hl_status hl_json_read_render(hl_json_reader *reader, const json_t *value, hl_render_settings *render) {
  static const char *const keys[] = {
      "shadows", "soft_method",   "light_samples",     "sheet_spacing", "kernel",      "reconstruction",
      "slicing", "shadow_lookup", "shadow_resolution", "threads",       "compositing", NULL};
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "render");
  int shadows = (int)render->shadows, method = (int)render->soft_method, kernel = (int)render->kernel,
      reconstruction = (int)render->reconstruction, slicing = (int)render->slicing,
      lookup = (int)render->shadow_lookup, compositing = (int)render->compositing;
  hl_status status = hl_json_object(reader, value, keys);
  if (status == HL_OK)
    status = hl_json_choice(reader, value, "shadows", hl_shadows_names, HL_SHADOWS_OFF, &shadows);
  if (status == HL_OK)
    status = hl_json_choice(reader, value, "soft_method", hl_soft_method_names, 0, &method);
  if (status == HL_OK) status = hl_json_integer(reader, value, "light_samples", &render->light_samples);
  if (status == HL_OK) status = hl_json_number(reader, value, "sheet_spacing", &render->sheet_spacing);
  if (status == HL_OK) status = hl_json_choice(reader, value, "kernel", hl_kernel_names, 0, &kernel);
  if (status == HL_OK)
    status = hl_json_choice(reader, value, "reconstruction", hl_reconstruction_names, 0, &reconstruction);
  if (status == HL_OK) status = hl_json_choice(reader, value, "slicing", hl_slicing_names, 0, &slicing);
  if (status == HL_OK)
    status = hl_json_choice(reader, value, "shadow_lookup", hl_shadow_lookup_names, 0, &lookup);
  if (status == HL_OK)
    status = hl_json_choice(reader, value, "compositing", hl_compositing_names, 0, &compositing);
  if (status == HL_OK) status = read_shadow_resolution(reader, value, &render->shadow_resolution);
  if (status == HL_OK) status = hl_json_integer(reader, value, "threads", &render->threads);
  if (status != HL_OK) return status;
  render->shadows = (hl_shadows)shadows;
  render->soft_method = (hl_soft_method)method;
  render->kernel = (hl_kernel)kernel;
  render->reconstruction = (hl_reconstruction)reconstruction;
  render->slicing = (hl_slicing)slicing;
  render->shadow_lookup = (hl_shadow_lookup)lookup;
  render->compositing = (hl_compositing)compositing;
  hl_json_leave(reader, mark);
  return HL_OK;
}
