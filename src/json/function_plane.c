/* json/function_plane.c - reads a transfer function of two numbers from JSON: its boxes, polygons, image and
 * curves. */
#include <string.h>

#include "core/memory.h"
#include "json/parts.h"
#include "scene/check/limits.h"
#include "scene/function/function_plane.h"

static hl_status read_second(hl_json_reader *reader, const json_t *value, hl_function_plane *plane) {
  static const char *const keys[] = {"volume", NULL};
  const json_t *second = json_object_get(value, "second");
  const char *name = json_string_value(second);
  if (name != NULL && strcmp(name, "gradient") == 0) {
    plane->second = HL_SECOND_GRADIENT;
    return HL_OK;
  }
  if (!json_is_object(second))
    return hl_json_fail(reader, HL_ERROR_INPUT, "second", "is %s: give \"gradient\" or {\"volume\": NAME}",
                        name != NULL ? "an unknown name" : hl_json_type_name(second));
  size_t mark = hl_json_enter(reader, "second");
  hl_status status = hl_json_object(reader, second, keys);
  if (status == HL_OK) status = hl_json_text(reader, second, "volume", &name);
  if (status == HL_OK && name == NULL)
    status = hl_json_fail(reader, HL_ERROR_INPUT, "volume", "is missing: give another volume's name");
  if (status != HL_OK) return status;
  hl_json_leave(reader, mark);
  plane->second = HL_SECOND_VOLUME;
  plane->volume = hl_copy_text(reader->context, name);
  return plane->volume != NULL ? HL_OK : hl_fail_memory(reader->error, strlen(name) + 1, "a name");
}

/* Reads a pair of numbers from a key that must be present. */
static hl_status read_pair(hl_json_reader *reader, const json_t *value, const char *key, double pair[2]) {
  if (json_object_get(value, key) == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, key, "is missing: give two numbers, [from, to]");
  return hl_json_numbers(reader, value, key, 2, pair);
}

static hl_status read_ranges(hl_json_reader *reader, const json_t *value, double low[2], double high[2]) {
  hl_status status = HL_OK;
  for (int a = 0; a < 2 && status == HL_OK; a++) {
    double range[2];
    status = read_pair(reader, value, hl_plane_range_keys[a], range);
    if (status == HL_OK) low[a] = range[0], high[a] = range[1];
  }
  return status;
}

static hl_status read_look(hl_json_reader *reader, const json_t *value, double color[3], double *opacity) {
  for (int c = 0; c < 3; c++) color[c] = 1;
  *opacity = 0.5;
  hl_status status = hl_json_numbers(reader, value, "color", 3, color);
  return status == HL_OK ? hl_json_number(reader, value, "opacity", opacity) : status;
}

static hl_status read_box(hl_json_reader *reader, const json_t *value, void *box) {
  static const char *const keys[] = {"value", "second", "color", "opacity", "edge", "sigma", NULL};
  hl_function_box *made = box;
  hl_status status = hl_json_object(reader, value, keys);
  if (status == HL_OK) status = read_ranges(reader, value, made->low, made->high);
  if (status == HL_OK) status = read_look(reader, value, made->color, &made->opacity);
  if (status == HL_OK) status = hl_json_numbers(reader, value, "edge", 2, made->edge);
  return status == HL_OK ? hl_json_number(reader, value, "sigma", &made->sigma) : status;
}

static hl_status read_vertices(hl_json_reader *reader, const json_t *value, hl_function_polygon *polygon) {
  const json_t *list = json_object_get(value, "vertices");
  size_t mark = hl_json_enter(reader, "vertices");
  hl_status status = hl_json_array(reader, list, 3, HL_LIMIT_VERTICES);
  if (status != HL_OK) return status;
  size_t count = json_array_size(list);
  double(*vertices)[2] = hl_allocate(reader->context, count, sizeof *vertices);
  if (vertices == NULL) return hl_fail_memory(reader->error, count * sizeof *vertices, "a polygon");
  polygon->vertices = (const double(*)[2])vertices;
  polygon->vertex_count = count;
  hl_json_leave(reader, mark);
  for (size_t v = 0; v < count && status == HL_OK; v++)
    status = hl_json_row(reader, json_array_get(list, v), "vertices", 2, vertices[v]);
  for (size_t v = 0; v < count; v++)
    for (int a = 0; a < 2; a++) polygon->apex[a] += vertices[v][a] / (double)count;
  return status;
}

static hl_status read_polygon(hl_json_reader *reader, const json_t *value, void *polygon) {
  static const char *const keys[] = {"vertices", "apex", "color", "opacity", "falloff", NULL};
  hl_function_polygon *made = polygon;
  hl_status status = hl_json_object(reader, value, keys);
  if (status == HL_OK) status = read_vertices(reader, value, made);
  if (status == HL_OK) status = hl_json_numbers(reader, value, "apex", 2, made->apex);
  if (status == HL_OK) status = read_look(reader, value, made->color, &made->opacity);
  made->falloff = 1;
  return status == HL_OK ? hl_json_number(reader, value, "falloff", &made->falloff) : status;
}

static hl_status read_image(hl_json_reader *reader, const json_t *value, hl_function_image *image) {
  static const char *const keys[] = {"file", "value", "second", NULL};
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "image");
  hl_status status = hl_json_object(reader, value, keys);
  if (status == HL_OK) status = read_ranges(reader, value, image->low, image->high);
  if (status == HL_OK)
    status = hl_json_load_image(
        reader, value, &(hl_json_image){&image->file, &image->pixels, &image->width, &image->height, 4});
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

static hl_status read_curves(hl_json_reader *reader, const json_t *value, hl_function_curves *curves) {
  static const char *const keys[] = {"opacity", "color", "own_color", "own_between", NULL};
  double *rows = NULL;
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "curves");
  hl_status status = hl_json_object(reader, value, keys);
  if (status == HL_OK && json_object_get(value, "opacity") == NULL)
    status = hl_json_fail(reader, HL_ERROR_INPUT, "opacity", "is missing: give [[value, opacity], ...]");
  if (status == HL_OK) status = hl_json_read_rows(reader, value, "opacity", 2, &rows, &curves->opacity_count);
  if (status == HL_OK) curves->opacity = (hl_opacity_point *)rows;
  if (status == HL_OK && json_object_get(value, "color") != NULL) {
    status = hl_json_read_rows(reader, value, "color", 4, &rows, &curves->color_count);
    if (status == HL_OK) curves->color = (hl_color_point *)rows;
  }
  if (status == HL_OK && json_object_get(value, "own_color") != NULL) {
    status = hl_json_read_rows(reader, value, "own_color", 4, &rows, &curves->own_color_count);
    if (status == HL_OK) curves->own_color = (hl_color_point *)rows;
  }
  if (status == HL_OK) status = hl_json_numbers(reader, value, "own_between", 2, curves->own_between);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

/* ---- all steps together ---- */

typedef hl_status read_shape(hl_json_reader *reader, const json_t *value, void *shape);

/* Reads a list of shapes that have `size` bytes each. *shapes is owned by the caller, also after a
 * failure. */
static hl_status read_shapes(hl_json_reader *reader, const json_t *object, const char *key, size_t size,
                             read_shape *read, void **shapes, size_t *count) {
  const json_t *list = json_object_get(object, key);
  if (list == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, key);
  hl_status status = hl_json_array(reader, list, 0, HL_LIMIT_SHAPES);
  if (status != HL_OK) return status;
  unsigned char *made = hl_allocate_zeroed(reader->context, json_array_size(list), size);
  if (made == NULL) return hl_fail_memory(reader->error, json_array_size(list) * size, "shapes");
  *shapes = made;
  *count = json_array_size(list);
  for (size_t n = 0; n < *count && status == HL_OK; n++) {
    size_t inner = hl_json_enter_index(reader, n);
    status = read(reader, json_array_get(list, n), made + n * size);
    if (status == HL_OK) hl_json_leave(reader, inner);
  }
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

static const char *const others[] = {"opacity", "color",  "colormap", "range",
                                     "scale",   "preset", "file",     NULL};

hl_status hl_json_read_plane(hl_json_reader *reader, const json_t *value, hl_function_plane *plane) {
  void *boxes = NULL, *polygons = NULL;
  for (const char *const *key = others; *key != NULL; key++)
    if (json_object_get(value, *key) != NULL)
      return hl_json_fail(reader, HL_ERROR_INPUT, *key,
                          "and second exclude each other: boxes, polygons, images and curves have opacities "
                          "and colours of their own");
  hl_status status = read_second(reader, value, plane);
  if (status == HL_OK)
    status = read_shapes(reader, value, "boxes", sizeof *plane->boxes, read_box, &boxes, &plane->box_count);
  plane->boxes = boxes;
  if (status == HL_OK)
    status = read_shapes(reader, value, "polygons", sizeof *plane->polygons, read_polygon, &polygons,
                         &plane->polygon_count);
  plane->polygons = polygons;
  if (status == HL_OK) status = read_image(reader, json_object_get(value, "image"), &plane->image);
  return status == HL_OK ? read_curves(reader, json_object_get(value, "curves"), &plane->curves) : status;
}
