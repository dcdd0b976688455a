/* json/write.c - writes a scene as JSON text, from which the same scene is read again. */
#define _GNU_SOURCE
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "core/door.h"
#include "core/memory.h"
#include "json/file_names.h"
#include "json/parts.h"
#include "json/read.h"
#include "json/shapes.h"
#include "json/text_writer.h"
#include "json/writable.h"
#include "mesh/mesh.h"
#include "scene/function/function_plane.h"
#include "scene/light/light_kind.h"
#include "scene/scene.h"
#include "scene/settings.h"
#include "text/json_value.h"
#include "text/plain.h"
#include "text/plain_json.h"

static void write_file(hl_json_writer *w, const char *file) {
  char name[PATH_MAX];
  hl_json_write_name(w, "file", w->beside != NULL ? hl_json_name_from(w->beside, file, name) : file);
}

static void write_setting(hl_json_writer *w, const hl_setting *setting, const void *object) {
  const char *slash = strrchr(setting->key, '/'), *key = slash != NULL ? slash + 1 : setting->key;
  const double *numbers = hl_setting_field_const(setting, object);
  const char *name = NULL;
  switch (setting->type) {
    case HL_SETTING_FLAG: hl_json_write_flag(w, key, hl_setting_whole(setting, object)); break;
    case HL_SETTING_NUMBER: hl_json_write_number(w, key, numbers[0]); break;
    case HL_SETTING_POINT:
    case HL_SETTING_DIRECTION:
    case HL_SETTING_COLOR: hl_json_write_row(w, key, numbers, 3); break;
    case HL_SETTING_WHOLE:
    case HL_SETTING_CHOICE:
      name = hl_setting_choice_name(setting, hl_setting_whole(setting, object));
      if (name != NULL) hl_json_write_name(w, key, name);
      else hl_json_write_number(w, key, hl_setting_whole(setting, object));
  }
}

static void write_key(hl_json_writer *w, hl_setting_kind kind, const char *key, const void *object) {
  write_setting(w, hl_setting_find(kind, key), object);
}

/* Writes a setting that objects of this type have. An optional setting is left out if it has its default. */
static void write_if_told(hl_json_writer *w, const hl_setting *setting, int type, const void *object) {
  if (!hl_setting_is_for(setting, type)) return;
  if (!setting->optional || !hl_setting_is_standard(setting, object)) write_setting(w, setting, object);
}

/* Writes the keys of a table that have no "/". */
static void write_settings(hl_json_writer *w, hl_setting_kind kind, int type, const void *object) {
  for (size_t s = 0; s < hl_setting_count(kind); s++)
    if (strchr(hl_setting_get(kind, s)->key, '/') == NULL)
      write_if_told(w, hl_setting_get(kind, s), type, object);
}

static void write_texture(hl_json_writer *w, const hl_light_texture *texture) {
  if (texture->pixels == NULL) return;
  hl_json_open(w, "texture", "{");
  write_file(w, texture->file);
  hl_json_open(w, "screen", "{");
  hl_json_write_row(w, "center", texture->screen_center, 3);
  hl_json_write_row(w, "right", texture->screen_right, 3);
  hl_json_write_row(w, "up", texture->screen_up, 3);
  hl_json_close(w, "}");
  hl_json_close(w, "}");
}

static void write_emission(hl_json_writer *w, const hl_light *light) {
  if (light->emission.pixels == NULL) return;
  hl_json_open(w, "emission", "{");
  write_file(w, light->emission.file);
  if (!hl_light_kind(light)->parallelogram) hl_json_write_row(w, "up", light->emission.up, 3);
  hl_json_close(w, "}");
}

static void write_vertices(hl_json_writer *w, const hl_light *light) {
  hl_json_open(w, "vertices", "[");
  for (size_t v = 0; v < light->vertex_count; v++) hl_json_write_row(w, NULL, light->vertices[v], 3);
  hl_json_close(w, "]");
}

static void write_light(hl_json_writer *w, const hl_light *light) {
  hl_json_open(w, NULL, "{");
  for (size_t s = 0; s < hl_setting_count(HL_SETTINGS_LIGHT); s++) {
    const hl_setting *setting = hl_setting_get(HL_SETTINGS_LIGHT, s);
    bool falloff = setting->offset == offsetof(hl_light, falloff);
    if (falloff && hl_light_kind(light)->outline) write_vertices(w, light);
    if (!falloff || !hl_light_kind(light)->parallel) write_if_told(w, setting, (int)light->type, light);
  }
  write_texture(w, &light->texture);
  write_emission(w, light);
  hl_json_close(w, "}");
}

static void write_sky(hl_json_writer *w, const hl_sky *sky) {
  if (sky->type == HL_SKY_NONE) return;
  hl_json_open(w, "sky", "{");
  write_settings(w, HL_SETTINGS_SKY, (int)sky->type, sky);
  if (sky->type == HL_SKY_IMAGE) write_file(w, sky->file);
  hl_json_close(w, "}");
}

static void write_opacity(hl_json_writer *w, const char *key, const hl_opacity_point *points, size_t count) {
  hl_json_open(w, key, "[");
  for (size_t p = 0; p < count; p++)
    hl_json_write_row(w, NULL, (double[2]){points[p].value, points[p].opacity}, 2);
  hl_json_close(w, "]");
}

static void write_colors(hl_json_writer *w, const char *key, const hl_color_point *points, size_t count) {
  hl_json_open(w, key, "[");
  for (size_t p = 0; p < count; p++) {
    const hl_color_point *point = &points[p];
    hl_json_write_row(w, NULL, (double[4]){point->value, point->color[0], point->color[1], point->color[2]},
                      4);
  }
  hl_json_close(w, "]");
}

static void write_ranges(hl_json_writer *w, const double low[2], const double high[2]) {
  for (int a = 0; a < 2; a++) hl_json_write_row(w, hl_plane_range_keys[a], (double[2]){low[a], high[a]}, 2);
}

static void write_box(hl_json_writer *w, const hl_function_box *box) {
  hl_json_open(w, NULL, "{");
  write_ranges(w, box->low, box->high);
  hl_json_write_row(w, "color", box->color, 3);
  hl_json_write_number(w, "opacity", box->opacity);
  if (box->edge[0] > 0 || box->edge[1] > 0) hl_json_write_row(w, "edge", box->edge, 2);
  if (box->sigma > 0) hl_json_write_number(w, "sigma", box->sigma);
  hl_json_close(w, "}");
}

static void write_polygon(hl_json_writer *w, const hl_function_polygon *polygon) {
  hl_json_open(w, NULL, "{");
  hl_json_open(w, "vertices", "[");
  for (size_t v = 0; v < polygon->vertex_count; v++) hl_json_write_row(w, NULL, polygon->vertices[v], 2);
  hl_json_close(w, "]");
  hl_json_write_row(w, "apex", polygon->apex, 2);
  hl_json_write_row(w, "color", polygon->color, 3);
  hl_json_write_number(w, "opacity", polygon->opacity);
  hl_json_write_number(w, "falloff", polygon->falloff);
  hl_json_close(w, "}");
}

static void write_plane(hl_json_writer *w, const hl_function_plane *plane) {
  if (plane->second == HL_SECOND_GRADIENT) hl_json_write_name(w, "second", "gradient");
  if (plane->second == HL_SECOND_VOLUME) {
    hl_json_open(w, "second", "{");
    hl_json_write_name(w, "volume", plane->volume);
    hl_json_close(w, "}");
  }
  hl_json_open(w, "boxes", "[");
  for (size_t b = 0; b < plane->box_count; b++) write_box(w, &plane->boxes[b]);
  hl_json_close(w, "]");
  if (plane->polygon_count > 0) {
    hl_json_open(w, "polygons", "[");
    for (size_t p = 0; p < plane->polygon_count; p++) write_polygon(w, &plane->polygons[p]);
    hl_json_close(w, "]");
  }
  if (plane->curves.opacity_count > 0) {
    hl_json_open(w, "curves", "{");
    write_opacity(w, "opacity", plane->curves.opacity, plane->curves.opacity_count);
    write_colors(w, "color", plane->curves.color, plane->curves.color_count);
    if (hl_curves_have_own(&plane->curves)) {
      write_colors(w, "own_color", plane->curves.own_color, plane->curves.own_color_count);
      hl_json_write_row(w, "own_between", plane->curves.own_between, 2);
    }
    hl_json_close(w, "}");
  }
  if (plane->image.pixels == NULL) return;
  hl_json_open(w, "image", "{");
  write_file(w, plane->image.file);
  write_ranges(w, plane->image.low, plane->image.high);
  hl_json_close(w, "}");
}

static void write_function_of_two(hl_json_writer *w, const hl_transfer_function *function) {
  hl_json_open(w, "transfer_function", "{");
  write_settings(w, HL_SETTINGS_TRANSFER_FUNCTION, 0, function);
  write_plane(w, &function->plane);
  if (function->gradient_opacity_count > 0)
    write_opacity(w, "gradient_opacity", function->gradient_opacity, function->gradient_opacity_count);
  hl_json_close(w, "}");
}

static void write_transfer_function(hl_json_writer *w, const hl_transfer_function *function) {
  if (function->plane.second != HL_SECOND_NONE) {
    write_function_of_two(w, function);
    return;
  }
  hl_json_open(w, "transfer_function", "{");
  write_settings(w, HL_SETTINGS_TRANSFER_FUNCTION, 0, function);
  write_opacity(w, "opacity", function->opacity, function->opacity_count);
  if (function->gradient_opacity_count > 0)
    write_opacity(w, "gradient_opacity", function->gradient_opacity, function->gradient_opacity_count);
  write_colors(w, "color", function->color, function->color_count);
  hl_json_close(w, "}");
}

/* Writes the rotation and the translation of a volume or a mesh. */
static void write_rotation(hl_json_writer *w, hl_setting_kind kind, const void *object) {
  hl_json_open(w, "rotate", "{");
  write_key(w, kind, "transform/rotate/axis", object);
  write_key(w, kind, "transform/rotate/angle_deg", object);
  hl_json_close(w, "}");
  write_key(w, kind, "transform/translate", object);
}

static void write_material(hl_json_writer *w, const hl_material *material) {
  hl_json_open(w, "material", "{");
  write_settings(w, HL_SETTINGS_MATERIAL, 0, material);
  hl_json_close(w, "}");
}

static void write_transform(hl_json_writer *w, const hl_scene_volume *volume) {
  hl_json_open(w, "transform", "{");
  const double *axis = volume->axis_scale;
  if (axis[0] == 1 && axis[1] == 1 && axis[2] == 1) hl_json_write_number(w, "scale", volume->scale);
  else
    hl_json_write_row(w, "scale",
                      (double[3]){hl_scene_volume_scale(volume, 0), hl_scene_volume_scale(volume, 1),
                                  hl_scene_volume_scale(volume, 2)},
                      3);
  write_rotation(w, HL_SETTINGS_VOLUME, volume);
  hl_json_close(w, "}");
}

static void write_json(hl_json_writer *w, const char *key, const json_t *value);

static void write_object(hl_json_writer *w, const char *key, const json_t *value) {
  const char *name;
  json_t *member;
  hl_json_open(w, key, "{");
  json_object_foreach((json_t *)value, name, member) write_json(w, name, member);
  hl_json_close(w, "}");
}

static void write_list(hl_json_writer *w, const char *key, const json_t *value) {
  if (json_is_number(json_array_get(value, 0))) {
    double numbers[3] = {0};
    for (size_t n = 0; n < 3; n++) numbers[n] = json_number_value(json_array_get(value, n));
    hl_json_write_row(w, key, numbers, json_array_size(value) < 3 ? json_array_size(value) : 3);
    return;
  }
  hl_json_open(w, key, "[");
  for (size_t n = 0; n < json_array_size(value); n++) write_json(w, NULL, json_array_get(value, n));
  hl_json_close(w, "]");
}

static void write_json(hl_json_writer *w, const char *key, const json_t *value) {
  if (json_is_object(value)) write_object(w, key, value);
  else if (json_is_array(value)) write_list(w, key, value);
  else if (json_is_string(value)) hl_json_write_name(w, key, json_string_value(value));
  else if (json_is_number(value)) hl_json_write_number(w, key, json_number_value(value));
  else hl_json_write_flag(w, key, json_is_true(value));
}

/* Writes the shapes of a text, with their named groups replaced by shapes. text: {"shapes": [...],
 * "voxel_size": h, "groups": ...}, checked by is_text_of_shapes(). */
static void write_shapes(hl_json_writer *w, const char *text) {
  json_t *root = hl_plain_json_load_text(text);
  json_t *shapes = hl_json_expand_shapes(json_object_get(root, "shapes"), json_object_get(root, "groups"));
  if (shapes == NULL) w->failed = true;
  write_list(w, "shapes", shapes);
  if (json_object_get(root, "voxel_size") != NULL)
    hl_json_write_number(w, "voxel_size", json_number_value(json_object_get(root, "voxel_size")));
  json_decref(shapes);
  json_decref(root);
}

/* Writes the name of a volume's file, and the options of loading that do not have their defaults. */
static void write_source(hl_json_writer *w, const hl_scene_volume *volume) {
  write_file(w, volume->file);
  if (volume->series != NULL) hl_json_write_name(w, "series", volume->series);
  if (volume->array != NULL) hl_json_write_name(w, "array", volume->array);
  const char *component = hl_component_name(volume->component);
  if (component != NULL) hl_json_write_name(w, "component", component);
  else if (volume->component >= 0) hl_json_write_number(w, "component", volume->component);
  if (volume->time >= 0) hl_json_write_number(w, "time", volume->time);
  if (volume->channel >= 0) hl_json_write_number(w, "channel", volume->channel);
  if (volume->level >= 0) hl_json_write_number(w, "level", volume->level);
  if (volume->spacing[0] > 0) hl_json_write_row(w, "spacing", volume->spacing, 3);
  if (volume->file_space != NULL) hl_json_write_name(w, "space", volume->file_space);
  if (hl_volume_smoothing(volume->volume) > 0)
    hl_json_write_number(w, "smooth", hl_volume_smoothing(volume->volume));
}

static void write_iso(hl_json_writer *w, const hl_scene_volume *volume) {
  if (volume->iso_count == 0) return;
  hl_json_open(w, "iso", "[");
  for (size_t i = 0; i < volume->iso_count; i++) {
    hl_json_open(w, NULL, "{");
    write_settings(w, HL_SETTINGS_ISO, 0, &volume->iso[i]);
    hl_json_close(w, "}");
  }
  hl_json_close(w, "]");
}

static void write_cuts(hl_json_writer *w, const hl_cut *cuts, size_t count) {
  if (count > 0) hl_json_open(w, "cuts", "[");
  for (size_t i = 0; i < count; i++) {
    hl_json_open(w, NULL, "{");
    write_settings(w, HL_SETTINGS_CUT, (int)cuts[i].type, &cuts[i]);
    hl_json_close(w, "}");
  }
  if (count > 0) hl_json_close(w, "]");
}

static void write_volume_cuts(hl_json_writer *w, const hl_scene_volume *volume) {
  write_cuts(w, volume->cuts, volume->cut_count);
  if (volume->cut_shading != HL_CUT_SHADING_FACE) write_key(w, HL_SETTINGS_VOLUME, "cut_shading", volume);
  if (volume->cut_casts_shadow) write_key(w, HL_SETTINGS_VOLUME, "cut_casts_shadow", volume);
}

static void write_scattering(hl_json_writer *w, const hl_scene_volume *volume) {
  const double *albedo = volume->albedo;
  bool white = albedo[0] == 1 && albedo[1] == 1 && albedo[2] == 1;
  if (volume->anisotropy == 0 && white && !volume->multiple_scattering) return;
  hl_json_open(w, "scattering", "{");
  if (volume->anisotropy != 0) write_key(w, HL_SETTINGS_VOLUME, "scattering/anisotropy", volume);
  if (!white) write_key(w, HL_SETTINGS_VOLUME, "scattering/albedo", volume);
  if (volume->multiple_scattering) write_key(w, HL_SETTINGS_VOLUME, "scattering/multiple", volume);
  hl_json_close(w, "}");
}

/* Writes the array "labels". masks: whether these are the labels of a mask, which also have a tint. */
static void write_labels(hl_json_writer *w, const hl_label *labels, size_t count, bool masks) {
  hl_json_open(w, "labels", "[");
  for (size_t n = 0; n < count; n++) {
    const hl_label *label = &labels[n];
    hl_json_open(w, NULL, "{");
    hl_json_write_whole(w, "value", label->value);
    if (label->name != NULL) hl_json_write_name(w, "name", label->name);
    hl_json_write_row(w, "color", label->color, 3);
    hl_json_write_number(w, "opacity", label->opacity);
    hl_json_write_flag(w, "visible", label->visible);
    if (masks) hl_json_write_number(w, "tint", label->tint);
    if (label->unlisted) hl_json_write_flag(w, "unlisted", label->unlisted);
    hl_json_close(w, "}");
  }
  hl_json_close(w, "]");
}

static void write_mask(hl_json_writer *w, const hl_mask *mask) {
  if (mask->volume == NULL) return;
  hl_json_open(w, "mask", "{");
  write_file(w, mask->file);
  if (mask->component >= 0) hl_json_write_number(w, "component", mask->component);
  write_labels(w, mask->labels, mask->label_count, true);
  hl_json_write_number(w, "rest", mask->rest);
  hl_json_close(w, "}");
}

static void write_volume(hl_json_writer *w, const hl_scene_volume *volume) {
  hl_json_open(w, NULL, "{");
  if (volume->name != NULL) hl_json_write_name(w, "name", volume->name);
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
    hl_json_open(w, "clip", "{");
    write_key(w, HL_SETTINGS_VOLUME, "clip/min", volume);
    write_key(w, HL_SETTINGS_VOLUME, "clip/max", volume);
    hl_json_close(w, "}");
  }
  if (volume->scraps_least > 0) {
    hl_json_open(w, "scraps", "{");
    write_key(w, HL_SETTINGS_VOLUME, "scraps/faint", volume);
    write_key(w, HL_SETTINGS_VOLUME, "scraps/firm", volume);
    write_key(w, HL_SETTINGS_VOLUME, "scraps/least", volume);
    hl_json_close(w, "}");
  }
  if (volume->legend_low < volume->legend_high) {
    hl_json_open(w, "legend", "{");
    write_key(w, HL_SETTINGS_VOLUME, "legend/low", volume);
    write_key(w, HL_SETTINGS_VOLUME, "legend/high", volume);
    hl_json_close(w, "}");
  }
  write_volume_cuts(w, volume);
  hl_json_close(w, "}");
}

static void put_float(hl_json_writer *w, float number) {
  char text[HL_JSON_NUMBER_BYTES];
  hl_plain_print(text, sizeof text, "%.9g", (double)number);
  hl_json_put_text(w, text);
}

/* Writes rows of floats on one line. If `rows` is null, nothing is written. */
static void write_floats(hl_json_writer *w, const char *key, const float *rows, size_t count, size_t width) {
  if (rows == NULL || count == 0) return;
  hl_json_begin_item(w, key);
  for (size_t n = 0; n < count * width; n++) {
    hl_json_put_text(w, n == 0 ? "[[" : n % width == 0 ? "], [" : ", ");
    put_float(w, rows[n]);
  }
  hl_json_put_text(w, "]]");
}

static void write_triangles(hl_json_writer *w, const uint32_t (*triangles)[3], size_t count) {
  hl_json_begin_item(w, "triangles");
  hl_json_put_text(w, "[");
  for (size_t n = 0; n < count; n++) {
    char text[60];
    snprintf(text, sizeof text, "%s[%u, %u, %u]", n > 0 ? ", " : "", (unsigned)triangles[n][0],
             (unsigned)triangles[n][1], (unsigned)triangles[n][2]);
    hl_json_put_text(w, text);
  }
  hl_json_put_text(w, "]");
}

static void write_lines(hl_json_writer *w, const hl_mesh_description *d) {
  const float(*point)[4] = d->line_points;
  hl_json_open(w, "lines", "[");
  for (size_t line = 0; line < d->line_count; point += d->line_lengths[line++])
    write_floats(w, NULL, point[0], d->line_lengths[line], 4);
  hl_json_close(w, "]");
}

/* Writes the arrays from which a mesh was made. The triangles of tubes are left out, because they follow from
 * the lines. */
static void write_arrays(hl_json_writer *w, const hl_mesh *mesh) {
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

static void write_mesh(hl_json_writer *w, const hl_scene_mesh *mesh) {
  hl_json_open(w, NULL, "{");
  if (mesh->name != NULL) hl_json_write_name(w, "name", mesh->name);
  if (mesh->file != NULL) write_file(w, mesh->file);
  else write_arrays(w, mesh->mesh);
  hl_json_open(w, "transform", "{");
  write_key(w, HL_SETTINGS_MESH, "transform/scale", mesh);
  write_rotation(w, HL_SETTINGS_MESH, mesh);
  hl_json_close(w, "}");
  write_settings(w, HL_SETTINGS_MESH, 0, mesh);
  write_material(w, &mesh->material);
  hl_json_close(w, "}");
}

static void write_meshes(hl_json_writer *w, const hl_scene_description *d) {
  if (d->mesh_count == 0) return;
  hl_json_open(w, "meshes", "[");
  for (size_t m = 0; m < d->mesh_count; m++) write_mesh(w, &d->meshes[m]);
  hl_json_close(w, "]");
}

static void write_scene(hl_json_writer *w, const hl_scene_description *d) {
  hl_json_open(w, NULL, "{");
  hl_json_write_number(w, "halflight", 1);
  if (d->description != NULL) hl_json_write_name(w, "description", d->description);
  hl_json_open(w, "image", "{");
  write_settings(w, HL_SETTINGS_IMAGE, 0, d);
  hl_json_close(w, "}");
  hl_json_open(w, "camera", "{");
  write_settings(w, HL_SETTINGS_CAMERA, (int)d->camera.type, &d->camera);
  hl_json_close(w, "}");
  write_settings(w, HL_SETTINGS_SCENE, 0, d);
  hl_json_open(w, "lights", "[");
  for (size_t l = 0; l < d->light_count; l++) write_light(w, &d->lights[l]);
  hl_json_close(w, "]");
  write_sky(w, &d->sky);
  if (d->volume_count > 0 || d->mesh_count == 0) {
    hl_json_open(w, "volumes", "[");
    for (size_t v = 0; v < d->volume_count; v++) write_volume(w, &d->volumes[v]);
    hl_json_close(w, "]");
  }
  write_meshes(w, d);
  write_cuts(w, d->cuts, d->cut_count);
  hl_json_write_marks(w, d->marks, d->mark_count);
  hl_json_open(w, "render", "{");
  write_settings(w, HL_SETTINGS_RENDER, 0, &d->render);
  hl_json_close(w, "}");
  hl_json_close(w, "}");
  hl_json_put_text(w, "\n");
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
  hl_json_writer w = {.context = context, .first = true};
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
