/* json/write.c - writes a scene as JSON text that reads back as the same scene.
 *
 * Numbers have the fewest digits that give the same double again; rows of numbers stay on one line.
 */
#define _GNU_SOURCE
#include <inttypes.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/door.h"
#include "core/memory.h"
#include "json/file_names.h"
#include "json/read.h"
#include "json/shapes.h"
#include "json/writable.h"
#include "mesh/mesh.h"
#include "scene/function_plane.h"
#include "scene/light_kind.h"
#include "scene/scene.h"
#include "scene/settings.h"
#include "text/json_value.h"
#include "text/plain.h"
#include "text/plain_json.h"

/* A growing text. After a failed allocation nothing more is written, and the end reports it. */
typedef struct writer {
  hl_context *context;
  char *text;
  size_t length, capacity;
  int depth;
  const char *beside; /* the folder in which file names start (file_names.h); null if names stay as they
                       * are */
  bool first;         /* whether there is no member or element yet at this depth */
  bool failed;
} writer;

static void put(writer *w, const char *text, size_t length) {
  if (!w->failed && w->length + length + 1 > w->capacity) {
    size_t capacity = 2 * w->capacity + length + 1024;
    char *grown = hl_reallocate(w->context, w->text, capacity, 1);
    if (grown == NULL) w->failed = true;
    else w->text = grown, w->capacity = capacity;
  }
  if (w->failed) return;
  memcpy(w->text + w->length, text, length);
  w->length += length;
  w->text[w->length] = 0;
}

static void put_text(writer *w, const char *text) { put(w, text, strlen(text)); }

/* Writes a comma if needed, a new line, the indentation, and the key if there is one. */
static void begin_item(writer *w, const char *key) {
  put_text(w, w->first ? "\n" : ",\n");
  w->first = false;
  for (int d = 0; d < w->depth; d++) put_text(w, "  ");
  if (key == NULL) return;
  put_text(w, "\"");
  put_text(w, key);
  put_text(w, "\": ");
}

static void open_bracket(writer *w, const char *key, const char *bracket) {
  if (w->depth > 0) begin_item(w, key);
  put_text(w, bracket);
  w->depth++;
  w->first = true;
}

static void close_bracket(writer *w, const char *bracket) {
  bool empty = w->first;
  w->depth--;
  w->first = true;
  if (!empty) begin_item(w, NULL);
  put_text(w, bracket);
  w->first = false;
}

static void put_number(writer *w, double number) {
  char text[HL_JSON_NUMBER_BYTES];
  hl_json_number_text(number, text);
  put_text(w, text);
}

static void put_quoted(writer *w, const char *text) {
  char piece[HL_JSON_PIECE_BYTES];
  put_text(w, "\"");
  for (size_t length; (length = hl_json_piece(&text, piece)) > 0;) put(w, piece, length);
  put_text(w, "\"");
}

static void write_number(writer *w, const char *key, double number) {
  begin_item(w, key);
  put_number(w, number);
}

static void write_whole(writer *w, const char *key, int64_t number) {
  char text[HL_JSON_NUMBER_BYTES];
  begin_item(w, key);
  snprintf(text, sizeof text, "%" PRId64, number);
  put_text(w, text);
}

static void write_row(writer *w, const char *key, const double *numbers, size_t count) {
  begin_item(w, key);
  put_text(w, "[");
  for (size_t n = 0; n < count; n++) {
    if (n > 0) put_text(w, ", ");
    put_number(w, numbers[n]);
  }
  put_text(w, "]");
}

static void write_name(writer *w, const char *key, const char *name) {
  begin_item(w, key);
  put_quoted(w, name);
}

static void write_file(writer *w, const char *file) {
  char name[PATH_MAX];
  write_name(w, "file", w->beside != NULL ? hl_json_name_from(w->beside, file, name) : file);
}

static void write_flag(writer *w, const char *key, int flag) {
  begin_item(w, key);
  put_text(w, flag ? "true" : "false");
}

static void write_setting(writer *w, const hl_setting *setting, const void *object) {
  const char *slash = strrchr(setting->key, '/'), *key = slash != NULL ? slash + 1 : setting->key;
  const double *numbers = hl_setting_field_const(setting, object);
  const char *name = NULL;
  switch (setting->type) {
    case HL_SETTING_FLAG: write_flag(w, key, hl_setting_whole(setting, object)); break;
    case HL_SETTING_NUMBER: write_number(w, key, numbers[0]); break;
    case HL_SETTING_POINT:
    case HL_SETTING_DIRECTION:
    case HL_SETTING_COLOR: write_row(w, key, numbers, 3); break;
    case HL_SETTING_WHOLE:
    case HL_SETTING_CHOICE:
      name = hl_setting_choice_name(setting, hl_setting_whole(setting, object));
      if (name != NULL) write_name(w, key, name);
      else write_number(w, key, hl_setting_whole(setting, object));
  }
}

static void write_key(writer *w, hl_setting_kind kind, const char *key, const void *object) {
  write_setting(w, hl_setting_find(kind, key), object);
}

/* Writes a setting, unless objects of this type do not have it, or it is optional and has its default. */
static void write_if_told(writer *w, const hl_setting *setting, int type, const void *object) {
  if (!hl_setting_is_for(setting, type)) return;
  if (!setting->optional || !hl_setting_is_standard(setting, object)) write_setting(w, setting, object);
}

/* Writes the keys of a table that have no "/". */
static void write_settings(writer *w, hl_setting_kind kind, int type, const void *object) {
  for (size_t s = 0; s < hl_setting_count(kind); s++)
    if (strchr(hl_setting_get(kind, s)->key, '/') == NULL)
      write_if_told(w, hl_setting_get(kind, s), type, object);
}

static void write_texture(writer *w, const hl_light_texture *texture) {
  if (texture->pixels == NULL) return;
  open_bracket(w, "texture", "{");
  write_file(w, texture->file);
  open_bracket(w, "screen", "{");
  write_row(w, "center", texture->screen_center, 3);
  write_row(w, "right", texture->screen_right, 3);
  write_row(w, "up", texture->screen_up, 3);
  close_bracket(w, "}");
  close_bracket(w, "}");
}

static void write_emission(writer *w, const hl_light *light) {
  if (light->emission.pixels == NULL) return;
  open_bracket(w, "emission", "{");
  write_file(w, light->emission.file);
  if (!hl_light_kind(light)->parallelogram) write_row(w, "up", light->emission.up, 3);
  close_bracket(w, "}");
}

static void write_vertices(writer *w, const hl_light *light) {
  open_bracket(w, "vertices", "[");
  for (size_t v = 0; v < light->vertex_count; v++) write_row(w, NULL, light->vertices[v], 3);
  close_bracket(w, "]");
}

static void write_light(writer *w, const hl_light *light) {
  open_bracket(w, NULL, "{");
  for (size_t s = 0; s < hl_setting_count(HL_SETTINGS_LIGHT); s++) {
    const hl_setting *setting = hl_setting_get(HL_SETTINGS_LIGHT, s);
    bool falloff = setting->offset == offsetof(hl_light, falloff);
    if (falloff && hl_light_kind(light)->outline) write_vertices(w, light);
    if (!falloff || !hl_light_kind(light)->parallel) write_if_told(w, setting, (int)light->type, light);
  }
  write_texture(w, &light->texture);
  write_emission(w, light);
  close_bracket(w, "}");
}

static void write_sky(writer *w, const hl_sky *sky) {
  if (sky->type == HL_SKY_NONE) return;
  open_bracket(w, "sky", "{");
  write_settings(w, HL_SETTINGS_SKY, (int)sky->type, sky);
  if (sky->type == HL_SKY_IMAGE) write_file(w, sky->file);
  close_bracket(w, "}");
}

static void write_opacity(writer *w, const char *key, const hl_opacity_point *points, size_t count) {
  open_bracket(w, key, "[");
  for (size_t p = 0; p < count; p++) write_row(w, NULL, (double[2]){points[p].value, points[p].opacity}, 2);
  close_bracket(w, "]");
}

static void write_ranges(writer *w, const double low[2], const double high[2]) {
  for (int a = 0; a < 2; a++) write_row(w, hl_plane_range_keys[a], (double[2]){low[a], high[a]}, 2);
}

static void write_box(writer *w, const hl_function_box *box) {
  open_bracket(w, NULL, "{");
  write_ranges(w, box->low, box->high);
  write_row(w, "color", box->color, 3);
  write_number(w, "opacity", box->opacity);
  if (box->edge[0] > 0 || box->edge[1] > 0) write_row(w, "edge", box->edge, 2);
  if (box->sigma > 0) write_number(w, "sigma", box->sigma);
  close_bracket(w, "}");
}

static void write_polygon(writer *w, const hl_function_polygon *polygon) {
  open_bracket(w, NULL, "{");
  open_bracket(w, "vertices", "[");
  for (size_t v = 0; v < polygon->vertex_count; v++) write_row(w, NULL, polygon->vertices[v], 2);
  close_bracket(w, "]");
  write_row(w, "apex", polygon->apex, 2);
  write_row(w, "color", polygon->color, 3);
  write_number(w, "opacity", polygon->opacity);
  write_number(w, "falloff", polygon->falloff);
  close_bracket(w, "}");
}

static void write_plane(writer *w, const hl_function_plane *plane) {
  if (plane->second == HL_SECOND_GRADIENT) write_name(w, "second", "gradient");
  if (plane->second == HL_SECOND_VOLUME) {
    open_bracket(w, "second", "{");
    write_name(w, "volume", plane->volume);
    close_bracket(w, "}");
  }
  open_bracket(w, "boxes", "[");
  for (size_t b = 0; b < plane->box_count; b++) write_box(w, &plane->boxes[b]);
  close_bracket(w, "]");
  if (plane->polygon_count > 0) {
    open_bracket(w, "polygons", "[");
    for (size_t p = 0; p < plane->polygon_count; p++) write_polygon(w, &plane->polygons[p]);
    close_bracket(w, "]");
  }
  if (plane->image.pixels == NULL) return;
  open_bracket(w, "image", "{");
  write_file(w, plane->image.file);
  write_ranges(w, plane->image.low, plane->image.high);
  close_bracket(w, "}");
}

static void write_function_of_two(writer *w, const hl_transfer_function *function) {
  open_bracket(w, "transfer_function", "{");
  write_settings(w, HL_SETTINGS_TRANSFER_FUNCTION, 0, function);
  write_plane(w, &function->plane);
  if (function->gradient_opacity_count > 0)
    write_opacity(w, "gradient_opacity", function->gradient_opacity, function->gradient_opacity_count);
  close_bracket(w, "}");
}

static void write_transfer_function(writer *w, const hl_transfer_function *function) {
  if (function->plane.second != HL_SECOND_NONE) {
    write_function_of_two(w, function);
    return;
  }
  open_bracket(w, "transfer_function", "{");
  write_settings(w, HL_SETTINGS_TRANSFER_FUNCTION, 0, function);
  write_opacity(w, "opacity", function->opacity, function->opacity_count);
  if (function->gradient_opacity_count > 0)
    write_opacity(w, "gradient_opacity", function->gradient_opacity, function->gradient_opacity_count);
  open_bracket(w, "color", "[");
  for (size_t p = 0; p < function->color_count; p++) {
    const hl_color_point *point = &function->color[p];
    write_row(w, NULL, (double[4]){point->value, point->color[0], point->color[1], point->color[2]}, 4);
  }
  close_bracket(w, "]");
  close_bracket(w, "}");
}

/* Writes the rotation and the translation of a volume or a mesh. */
static void write_rotation(writer *w, hl_setting_kind kind, const void *object) {
  open_bracket(w, "rotate", "{");
  write_key(w, kind, "transform/rotate/axis", object);
  write_key(w, kind, "transform/rotate/angle_deg", object);
  close_bracket(w, "}");
  write_key(w, kind, "transform/translate", object);
}

static void write_material(writer *w, const hl_material *material) {
  open_bracket(w, "material", "{");
  write_settings(w, HL_SETTINGS_MATERIAL, 0, material);
  close_bracket(w, "}");
}

static void write_transform(writer *w, const hl_scene_volume *volume) {
  open_bracket(w, "transform", "{");
  const double *axis = volume->axis_scale;
  if (axis[0] == 1 && axis[1] == 1 && axis[2] == 1) write_number(w, "scale", volume->scale);
  else
    write_row(w, "scale",
              (double[3]){hl_scene_volume_scale(volume, 0), hl_scene_volume_scale(volume, 1),
                          hl_scene_volume_scale(volume, 2)},
              3);
  write_rotation(w, HL_SETTINGS_VOLUME, volume);
  close_bracket(w, "}");
}

static void write_json(writer *w, const char *key, const json_t *value);

static void write_object(writer *w, const char *key, const json_t *value) {
  const char *name;
  json_t *member;
  open_bracket(w, key, "{");
  json_object_foreach((json_t *)value, name, member) write_json(w, name, member);
  close_bracket(w, "}");
}

static void write_list(writer *w, const char *key, const json_t *value) {
  if (json_is_number(json_array_get(value, 0))) {
    double numbers[3] = {0};
    for (size_t n = 0; n < 3; n++) numbers[n] = json_number_value(json_array_get(value, n));
    write_row(w, key, numbers, json_array_size(value) < 3 ? json_array_size(value) : 3);
    return;
  }
  open_bracket(w, key, "[");
  for (size_t n = 0; n < json_array_size(value); n++) write_json(w, NULL, json_array_get(value, n));
  close_bracket(w, "]");
}

static void write_json(writer *w, const char *key, const json_t *value) {
  if (json_is_object(value)) write_object(w, key, value);
  else if (json_is_array(value)) write_list(w, key, value);
  else if (json_is_string(value)) write_name(w, key, json_string_value(value));
  else if (json_is_number(value)) write_number(w, key, json_number_value(value));
  else write_flag(w, key, json_is_true(value));
}

/* Writes shapes with their groups expanded. text: {"shapes": [...], "voxel_size": h, "groups": ...}, checked
 * by is_text_of_shapes(). */
static void write_shapes(writer *w, const char *text) {
  json_t *root = hl_plain_json_load_text(text);
  json_t *shapes = hl_json_expand_shapes(json_object_get(root, "shapes"), json_object_get(root, "groups"));
  if (shapes == NULL) w->failed = true;
  write_list(w, "shapes", shapes);
  if (json_object_get(root, "voxel_size") != NULL)
    write_number(w, "voxel_size", json_number_value(json_object_get(root, "voxel_size")));
  json_decref(shapes);
  json_decref(root);
}

/* Writes the file, and the options of loading that differ from the default. */
static void write_source(writer *w, const hl_scene_volume *volume) {
  write_file(w, volume->file);
  if (volume->series != NULL) write_name(w, "series", volume->series);
  if (volume->array != NULL) write_name(w, "array", volume->array);
  const char *component = hl_component_name(volume->component);
  if (component != NULL) write_name(w, "component", component);
  else if (volume->component >= 0) write_number(w, "component", volume->component);
  if (volume->time >= 0) write_number(w, "time", volume->time);
  if (volume->channel >= 0) write_number(w, "channel", volume->channel);
  if (volume->level >= 0) write_number(w, "level", volume->level);
  if (volume->spacing[0] > 0) write_row(w, "spacing", volume->spacing, 3);
  if (hl_volume_smoothing(volume->volume) > 0) write_number(w, "smooth", hl_volume_smoothing(volume->volume));
}

static void write_iso(writer *w, const hl_scene_volume *volume) {
  if (volume->iso_count == 0) return;
  open_bracket(w, "iso", "[");
  for (size_t i = 0; i < volume->iso_count; i++) {
    open_bracket(w, NULL, "{");
    write_settings(w, HL_SETTINGS_ISO, 0, &volume->iso[i]);
    close_bracket(w, "}");
  }
  close_bracket(w, "]");
}

static void write_cuts(writer *w, const hl_cut *cuts, size_t count) {
  if (count > 0) open_bracket(w, "cuts", "[");
  for (size_t i = 0; i < count; i++) {
    open_bracket(w, NULL, "{");
    write_settings(w, HL_SETTINGS_CUT, (int)cuts[i].type, &cuts[i]);
    close_bracket(w, "}");
  }
  if (count > 0) close_bracket(w, "]");
}

static void write_volume_cuts(writer *w, const hl_scene_volume *volume) {
  write_cuts(w, volume->cuts, volume->cut_count);
  if (volume->cut_shading != HL_CUT_SHADING_FACE) write_key(w, HL_SETTINGS_VOLUME, "cut_shading", volume);
  if (volume->cut_casts_shadow) write_key(w, HL_SETTINGS_VOLUME, "cut_casts_shadow", volume);
}

static void write_scattering(writer *w, const hl_scene_volume *volume) {
  const double *albedo = volume->albedo;
  bool white = albedo[0] == 1 && albedo[1] == 1 && albedo[2] == 1;
  if (volume->anisotropy == 0 && white && !volume->multiple_scattering) return;
  open_bracket(w, "scattering", "{");
  if (volume->anisotropy != 0) write_key(w, HL_SETTINGS_VOLUME, "scattering/anisotropy", volume);
  if (!white) write_key(w, HL_SETTINGS_VOLUME, "scattering/albedo", volume);
  if (volume->multiple_scattering) write_key(w, HL_SETTINGS_VOLUME, "scattering/multiple", volume);
  close_bracket(w, "}");
}

/* Writes labels. masks: whether the labels belong to a mask, and tint. */
static void write_labels(writer *w, const hl_label *labels, size_t count, bool masks) {
  open_bracket(w, "labels", "[");
  for (size_t n = 0; n < count; n++) {
    const hl_label *label = &labels[n];
    open_bracket(w, NULL, "{");
    write_whole(w, "value", label->value);
    if (label->name != NULL) write_name(w, "name", label->name);
    write_row(w, "color", label->color, 3);
    write_number(w, "opacity", label->opacity);
    write_flag(w, "visible", label->visible);
    if (masks) write_number(w, "tint", label->tint);
    close_bracket(w, "}");
  }
  close_bracket(w, "]");
}

static void write_mask(writer *w, const hl_mask *mask) {
  if (mask->volume == NULL) return;
  open_bracket(w, "mask", "{");
  write_file(w, mask->file);
  if (mask->component >= 0) write_number(w, "component", mask->component);
  write_labels(w, mask->labels, mask->label_count, true);
  write_number(w, "rest", mask->rest);
  close_bracket(w, "}");
}

static void write_volume(writer *w, const hl_scene_volume *volume) {
  open_bracket(w, NULL, "{");
  if (volume->name != NULL) write_name(w, "name", volume->name);
  if (volume->shapes != NULL) write_shapes(w, volume->shapes);
  else write_source(w, volume);
  write_transform(w, volume);
  if (volume->label_count > 0) write_labels(w, volume->labels, volume->label_count, false);
  else write_transfer_function(w, &volume->transfer_function);
  write_mask(w, &volume->mask);
  write_iso(w, volume);
  write_key(w, HL_SETTINGS_VOLUME, "shading", volume);
  write_material(w, &volume->material);
  write_key(w, HL_SETTINGS_VOLUME, "attenuation_color", volume);
  write_scattering(w, volume);
  write_key(w, HL_SETTINGS_VOLUME, "visible", volume);
  write_key(w, HL_SETTINGS_VOLUME, "casts_shadow", volume);
  write_key(w, HL_SETTINGS_VOLUME, "receives_shadow", volume);
  if (volume->clipped) {
    open_bracket(w, "clip", "{");
    write_key(w, HL_SETTINGS_VOLUME, "clip/min", volume);
    write_key(w, HL_SETTINGS_VOLUME, "clip/max", volume);
    close_bracket(w, "}");
  }
  write_volume_cuts(w, volume);
  close_bracket(w, "}");
}

static void put_float(writer *w, float number) {
  char text[HL_JSON_NUMBER_BYTES];
  hl_plain_print(text, sizeof text, "%.9g", (double)number);
  put_text(w, text);
}

/* Writes rows of floats on one line. If the rows are null, nothing is written. */
static void write_floats(writer *w, const char *key, const float *rows, size_t count, size_t width) {
  if (rows == NULL || count == 0) return;
  begin_item(w, key);
  for (size_t n = 0; n < count * width; n++) {
    put_text(w, n == 0 ? "[[" : n % width == 0 ? "], [" : ", ");
    put_float(w, rows[n]);
  }
  put_text(w, "]]");
}

static void write_triangles(writer *w, const uint32_t (*triangles)[3], size_t count) {
  begin_item(w, "triangles");
  put_text(w, "[");
  for (size_t n = 0; n < count; n++) {
    char text[60];
    snprintf(text, sizeof text, "%s[%u, %u, %u]", n > 0 ? ", " : "", (unsigned)triangles[n][0],
             (unsigned)triangles[n][1], (unsigned)triangles[n][2]);
    put_text(w, text);
  }
  put_text(w, "]");
}

static void write_lines(writer *w, const hl_mesh_description *d) {
  const float(*point)[4] = d->line_points;
  open_bracket(w, "lines", "[");
  for (size_t line = 0; line < d->line_count; point += d->line_lengths[line++])
    write_floats(w, NULL, point[0], d->line_lengths[line], 4);
  close_bracket(w, "]");
}

/* Writes the arrays of which the mesh was made. Tubes are left out, as they follow from lines. */
static void write_arrays(writer *w, const hl_mesh *mesh) {
  const hl_mesh_description *d = &mesh->description;
  if (mesh->given_triangles > 0) {
    write_floats(w, "vertices", d->positions[0], mesh->given_vertices, 3);
    write_triangles(w, d->triangles, mesh->given_triangles);
    if (d->normals != NULL) write_floats(w, "normals", d->normals[0], mesh->given_vertices, 3);
    if (d->colors != NULL) write_floats(w, "colors", d->colors[0], mesh->given_vertices, 4);
    if (d->face_colors != NULL) write_floats(w, "face_colors", d->face_colors[0], mesh->given_triangles, 4);
  }
  if (d->sphere_count > 0) write_floats(w, "spheres", d->spheres[0], d->sphere_count, 4);
  if (d->sphere_colors != NULL) write_floats(w, "sphere_colors", d->sphere_colors[0], d->sphere_count, 4);
  if (d->line_count > 0) write_lines(w, d);
  if (d->line_colors != NULL) write_floats(w, "line_colors", d->line_colors[0], d->line_point_count, 4);
}

static void write_mesh(writer *w, const hl_scene_mesh *mesh) {
  open_bracket(w, NULL, "{");
  if (mesh->name != NULL) write_name(w, "name", mesh->name);
  if (mesh->file != NULL) write_file(w, mesh->file);
  else write_arrays(w, mesh->mesh);
  open_bracket(w, "transform", "{");
  write_key(w, HL_SETTINGS_MESH, "transform/scale", mesh);
  write_rotation(w, HL_SETTINGS_MESH, mesh);
  close_bracket(w, "}");
  write_settings(w, HL_SETTINGS_MESH, 0, mesh);
  write_material(w, &mesh->material);
  close_bracket(w, "}");
}

static void write_meshes(writer *w, const hl_scene_description *d) {
  if (d->mesh_count == 0) return;
  open_bracket(w, "meshes", "[");
  for (size_t m = 0; m < d->mesh_count; m++) write_mesh(w, &d->meshes[m]);
  close_bracket(w, "]");
}

static void write_scene(writer *w, const hl_scene_description *d) {
  open_bracket(w, NULL, "{");
  write_number(w, "halflight", 1);
  if (d->description != NULL) write_name(w, "description", d->description);
  open_bracket(w, "image", "{");
  write_settings(w, HL_SETTINGS_IMAGE, 0, d);
  close_bracket(w, "}");
  open_bracket(w, "camera", "{");
  write_settings(w, HL_SETTINGS_CAMERA, (int)d->camera.type, &d->camera);
  close_bracket(w, "}");
  write_settings(w, HL_SETTINGS_SCENE, 0, d);
  open_bracket(w, "lights", "[");
  for (size_t l = 0; l < d->light_count; l++) write_light(w, &d->lights[l]);
  close_bracket(w, "]");
  write_sky(w, &d->sky);
  if (d->volume_count > 0 || d->mesh_count == 0) {
    open_bracket(w, "volumes", "[");
    for (size_t v = 0; v < d->volume_count; v++) write_volume(w, &d->volumes[v]);
    close_bracket(w, "]");
  }
  write_meshes(w, d);
  write_cuts(w, d->cuts, d->cut_count);
  open_bracket(w, "render", "{");
  write_settings(w, HL_SETTINGS_RENDER, 0, &d->render);
  close_bracket(w, "}");
  close_bracket(w, "}");
  put_text(w, "\n");
}

hl_status hl_scene_to_json(hl_context *context, const hl_scene *scene, char **text, hl_error *error) {
  HL_DOOR;
  return hl_scene_to_json_beside(context, scene, NULL, text, error);
}

hl_status hl_scene_to_json_beside(hl_context *context, const hl_scene *scene, const char *folder, char **text,
                                  hl_error *error) {
  HL_DOOR;
  char found[PATH_MAX];
  if (context == NULL || scene == NULL || text == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_to_json: null context, scene or text");
  *text = NULL;
  hl_status status = hl_json_check_writable(&scene->description, error);
  if (status != HL_OK) return status;
  writer w = {.context = context, .first = true};
  if (folder != NULL && hl_json_find_folder(folder, found)) w.beside = found;
  write_scene(&w, &scene->description);
  if (w.failed) {
    hl_release(context, w.text);
    return hl_fail_memory(error, w.length, "a scene's text");
  }
  *text = w.text;
  return HL_OK;
}

void hl_text_release(hl_context *context, char *text) { hl_release(context, text); }
