/* json/transfer_function.c - reads a transfer function from JSON: points, a colormap, a preset or another
 * file.
 *
 * The function starts as the named preset or file. If neither is named and no opacity is given, it starts as
 * the automatic function, or for volumes of shapes as an opaque solid. The points, the colormap and the
 * unit_distance of the scene then replace the starting function's. The file of a function may be a scene,
 * from which the first volume's function is taken, or a file of another program. */
#include <string.h>

#include "core/door.h"
#include "core/file.h"
#include "core/memory.h"
#include "json/foreign/paraview_state.h"
#include "json/foreign/slicer.h"
#include "json/parts.h"
#include "json/settings.h"
#include "scene/check/check.h"
#include "scene/function/function_plane.h"
#include "scene/scene.h"
#include "volume/io/text.h"

static bool has(const json_t *object, const char *key) { return json_object_get(object, key) != NULL; }

hl_status hl_json_read_rows(hl_json_reader *reader, const json_t *object, const char *key, size_t width,
                            double **rows, size_t *count) {
  const json_t *value = json_object_get(object, key);
  size_t mark = hl_json_enter(reader, key);
  hl_status status = hl_json_array(reader, value, 0, HL_LIMIT_POINTS);
  if (status != HL_OK) return status;
  *count = json_array_size(value);
  *rows = hl_allocate(reader->context, *count * width, sizeof **rows);
  if (*rows == NULL)
    return hl_fail_memory(reader->error, *count * width * sizeof **rows, "a transfer function");
  for (size_t r = 0; status == HL_OK && r < *count; r++) {
    const json_t *row = json_array_get(value, r);
    size_t inner = hl_json_enter_index(reader, r);
    status = hl_json_array(reader, row, width, width);
    for (size_t n = 0; status == HL_OK && n < width; n++) {
      char index[2] = {(char)('0' + n), 0};
      const json_t *element = json_array_get(row, n);
      if (json_is_number(element)) (*rows)[r * width + n] = json_number_value(element);
      else
        status = hl_json_fail(reader, HL_ERROR_INPUT, index, "is no number: give %s",
                              n == 0 ? "a data value" : "a number from 0 to 1");
    }
    if (status == HL_OK) hl_json_leave(reader, inner);
  }
  if (status == HL_OK) {
    hl_json_leave(reader, mark);
    return HL_OK;
  }
  hl_release(reader->context, *rows);
  *rows = NULL;
  return status;
}

_Static_assert(sizeof(hl_opacity_point) == 2 * sizeof(double), "opacity points are rows of two numbers");
_Static_assert(sizeof(hl_color_point) == 4 * sizeof(double), "colour points are rows of four numbers");

/* Across a solid's surface, the density falls from 1 to 0 over HL_SHAPE_EDGE voxels. The default opacity
 * rises from 0 to its full value within one voxel in the middle of this distance. */
enum { SOLID_POINTS = 2 };
static const double solid_begins = 0.375, solid_is_full = 0.625, solid_opacity = 0.95;

/* Makes the outside of a solid fully transparent, and gives the inside a given opacity. */
static hl_status set_solid_opacity(hl_json_reader *reader, double opacity, hl_transfer_function *function) {
  hl_opacity_point *points = hl_allocate(reader->context, SOLID_POINTS, sizeof *points);
  if (points == NULL)
    return hl_fail_memory(reader->error, SOLID_POINTS * sizeof *points, "a transfer function");
  points[0] = (hl_opacity_point){solid_begins, 0};
  points[1] = (hl_opacity_point){solid_is_full, opacity};
  hl_release(reader->context, (void *)function->opacity);
  function->opacity = points;
  function->opacity_count = SOLID_POINTS;
  return HL_OK;
}

/* Reads a colour that the function gives to all values. */
static hl_status read_plain_color(hl_json_reader *reader, const json_t *value,
                                  hl_transfer_function *function) {
  hl_color_point *point = hl_allocate_zeroed(reader->context, 1, sizeof *point);
  if (point == NULL) return hl_fail_memory(reader->error, sizeof *point, "a transfer function");
  hl_release(reader->context, (void *)function->color);
  function->color = point;
  function->color_count = 1;
  return hl_json_numbers(reader, value, "color", 3, point->color);
}

/* Makes the transfer function of an opaque solid. The full opacity is reached within the edge of one voxel,
 * so that light does not enter the solid more deeply than one voxel. */
static hl_status read_solid(hl_json_reader *reader, const hl_volume *volume, hl_transfer_function *function) {
  function->unit_distance = mat3_shortest_column(volume->index_to_world.linear);
  return set_solid_opacity(reader, solid_opacity, function);
}

hl_status hl_json_clear_function(hl_json_reader *reader, const hl_volume *volume,
                                 hl_transfer_function *function) {
  *function = (hl_transfer_function){.unit_distance = mat3_shortest_column(volume->index_to_world.linear)};
  hl_opacity_point *opacity = hl_allocate_zeroed(reader->context, 1, sizeof *opacity);
  hl_color_point *color = hl_allocate_zeroed(reader->context, 1, sizeof *color);
  function->opacity = opacity, function->opacity_count = 1;
  function->color = color, function->color_count = 1;
  if (opacity == NULL || color == NULL)
    return hl_fail_memory(reader->error, sizeof *color, "a transfer function");
  opacity->value = color->value = volume->minimum;
  for (int c = 0; c < 3; c++) color->color[c] = 1;
  return HL_OK;
}

static hl_status read_points(hl_json_reader *reader, const json_t *value, bool is_solid,
                             hl_transfer_function *function) {
  hl_status status = HL_OK;
  double *rows = NULL;
  size_t count = 0;
  const json_t *opacity = json_object_get(value, "opacity");
  if (is_solid && json_is_number(opacity)) {
    double inside = json_number_value(opacity);
    if (!(inside >= 0 && inside <= 1))
      return hl_json_fail(reader, HL_ERROR_INPUT, "opacity",
                          "%.9g is out of range: give an opacity from 0 to 1", inside);
    if ((status = set_solid_opacity(reader, inside, function)) != HL_OK) return status;
  } else if (opacity != NULL) {
    if ((status = hl_json_read_rows(reader, value, "opacity", 2, &rows, &count)) != HL_OK) return status;
    hl_release(reader->context, (void *)function->opacity);
    function->opacity = (hl_opacity_point *)rows;
    function->opacity_count = count;
  }
  if (has(value, "gradient_opacity")) {
    if ((status = hl_json_read_rows(reader, value, "gradient_opacity", 2, &rows, &count)) != HL_OK)
      return status;
    hl_release(reader->context, (void *)function->gradient_opacity);
    function->gradient_opacity = (hl_opacity_point *)rows;
    function->gradient_opacity_count = count;
  }
  if (json_is_number(json_array_get(json_object_get(value, "color"), 0)))
    return read_plain_color(reader, value, function);
  if (has(value, "color")) {
    if ((status = hl_json_read_rows(reader, value, "color", 4, &rows, &count)) != HL_OK) return status;
    hl_release(reader->context, (void *)function->color);
    function->color = (hl_color_point *)rows;
    function->color_count = count;
  }
  return status;
}

/* Spreads the starting function over the range that `value` gives. Does nothing if `value` gives no range.
 * Also does nothing if `value` gives a colormap, because the colormap is then spread over the range
 * instead. */
static hl_status spread_start(hl_json_reader *reader, const json_t *value, hl_function_subject subject,
                              const hl_json_range *range, hl_transfer_function *function) {
  const hl_volume *volume = subject.volume;
  const hl_spread_use use = subject.projected ? HL_SPREAD_PROJECTION : HL_SPREAD_ALONE;
  hl_transfer_function spread;
  if (!range->given || has(value, "colormap")) return HL_OK;
  if (volume == NULL || has(value, "opacity"))
    return hl_json_fail(reader, HL_ERROR_INPUT, has(value, "range") ? "range" : "scale",
                        "is for a colormap, a preset, a file or the automatic function: give one of them, or "
                        "remove it");
  hl_status status = hl_transfer_function_spread_over(reader->context, volume, function, range->ends,
                                                      range->scale, use, &spread, reader->error);
  if (status != HL_OK) return hl_json_prefix(reader, reader->place), status;
  hl_transfer_function_release(reader->context, function);
  *function = spread;
  return HL_OK;
}

static hl_status read_colormap(hl_json_reader *reader, const json_t *value, const hl_json_range *range,
                               hl_transfer_function *function) {
  const char *name = NULL;
  hl_status status = hl_json_text(reader, value, "colormap", &name);
  if (status != HL_OK || name == NULL) return status;
  if (has(value, "color"))
    return hl_json_fail(reader, HL_ERROR_INPUT, "colormap", "and color exclude each other: remove one");
  status = hl_transfer_function_colormap_scaled(reader->context, name, range->ends, range->scale, function,
                                                reader->error);
  if (status == HL_ERROR_INPUT) {
    hl_json_enter(reader, "colormap");
    hl_json_prefix(reader, reader->place);
  }
  return status;
}

/* Takes opacity and unit_distance from the automatic function. This function is called for files that have
 * only colours. */
static hl_status take_automatic_opacity(hl_json_reader *reader, const hl_volume *volume,
                                        hl_transfer_function *function) {
  hl_transfer_function automatic;
  hl_status status = hl_transfer_function_automatic(reader->context, volume, &automatic, reader->error);
  if (status != HL_OK) return status;
  function->unit_distance = automatic.unit_distance;
  function->opacity = automatic.opacity;
  function->opacity_count = automatic.opacity_count;
  hl_release(reader->context, (void *)automatic.color);
  return HL_OK;
}

/* Reads the function that `value` starts from: a preset, a file or the automatic function. Points, colormap
 * and unit_distance change this function later. */
static hl_status read_start(hl_json_reader *reader, const json_t *value, hl_function_subject subject,
                            hl_transfer_function *function) {
  const hl_volume *volume = subject.volume;
  const char *preset = NULL, *file = NULL, *key = "preset";
  hl_status status = hl_json_text(reader, value, "preset", &preset);
  if (status == HL_OK) status = hl_json_text(reader, value, "file", &file);
  if (status != HL_OK) return status;
  if (preset != NULL && file != NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "file", "and preset exclude each other: remove one");
  if (preset != NULL) {
    if (volume == NULL)
      return hl_json_fail(reader, HL_ERROR_INPUT, key, "needs a volume to adapt to: use it in a scene");
    status = hl_transfer_function_preset(reader->context, preset, volume, function, reader->error);
  } else if (file != NULL) {
    key = "file";
    if (volume == NULL)
      return hl_json_fail(reader, HL_ERROR_INPUT, key, "in a file of its own: name that file directly");
    if (reader->like != NULL)
      return hl_json_fail(reader, HL_ERROR_INPUT, key,
                          "no file is opened for a changed scene: give its points");
    char *path = hl_path_join(reader->context, reader->folder, file);
    if (path == NULL) return hl_fail_memory(reader->error, strlen(file) + 1, "a path");
    status = hl_transfer_function_load_for(reader->context, path, volume, function, reader->error);
    hl_release(reader->context, path);
    if (status == HL_OK && function->opacity == NULL && !hl_has_plane(function) && !has(value, "opacity"))
      status = take_automatic_opacity(reader, volume, function);
  } else if (!has(value, "opacity")) {
    key = NULL;
    if (subject.is_solid) return read_solid(reader, volume, function);
    if (volume != NULL)
      status = hl_transfer_function_automatic(reader->context, volume, function, reader->error);
    else if (!has(value, "color") && !has(value, "colormap"))
      return hl_json_fail(reader, HL_ERROR_INPUT, "opacity", "is missing: give [[value, opacity], ...]");
  }
  if (status == HL_OK) return HL_OK;
  if (key != NULL) hl_json_enter(reader, key);
  hl_json_prefix(reader, reader->place);
  return status;
}

/* Refuses boxes, polygons, images and curves of a function that has no second number. */
static hl_status refuse_shapes(hl_json_reader *reader, const json_t *value) {
  for (const char *const *key = (const char *const[]){"boxes", "polygons", "image", "curves", NULL};
       *key != NULL; key++)
    if (has(value, *key))
      return hl_json_fail(reader, HL_ERROR_INPUT, *key,
                          "needs a second number: give \"second\": \"gradient\" or {\"volume\": NAME}");
  return HL_OK;
}

static hl_status read_members(hl_json_reader *reader, const json_t *value, hl_function_subject subject,
                              hl_transfer_function *function) {
  static const char *const keys[] = {
      "unit_distance", "opacity", "gradient_opacity", "color", "colormap", "range", "scale", "preset", "file",
      "second",        "boxes",   "polygons",         "image", "curves",   NULL};
  hl_json_range range;
  hl_status status = hl_json_object(reader, value, keys);
  bool of_two = has(value, "second");
  if (status == HL_OK && !of_two) status = refuse_shapes(reader, value);
  if (status == HL_OK)
    status = of_two ? hl_json_read_plane(reader, value, &function->plane)
                    : read_start(reader, value, subject, function);
  if (status == HL_OK) status = hl_json_read_range(reader, value, subject.volume, &range);
  if (status == HL_OK && !of_two) status = spread_start(reader, value, subject, &range, function);
  if (status == HL_OK) status = hl_json_settings(reader, value, HL_SETTINGS_TRANSFER_FUNCTION, 0, function);
  if (status == HL_OK) status = read_points(reader, value, subject.is_solid, function);
  return status == HL_OK ? read_colormap(reader, value, &range, function) : status;
}

hl_status hl_json_read_transfer_function(hl_json_reader *reader, const json_t *value,
                                         hl_function_subject subject, hl_transfer_function *function) {
  *function = (hl_transfer_function){.unit_distance = 1};
  if (value == NULL && subject.is_solid && !subject.projected)
    return read_solid(reader, subject.volume, function);
  if (value == NULL) {
    hl_status status = subject.projected ? hl_transfer_function_preset(reader->context, "mip", subject.volume,
                                                                       function, reader->error)
                                         : hl_transfer_function_automatic(reader->context, subject.volume,
                                                                          function, reader->error);
    if (status != HL_OK) hl_json_prefix(reader, reader->place);
    return status;
  }
  /* If a file holds a function alone, the function is the whole JSON text, so that errors name no key around
   * it. */
  size_t mark = subject.volume != NULL ? hl_json_enter(reader, "transfer_function") : 0;
  hl_status status = read_members(reader, value, subject, function);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

/* Reads the transfer function of a scene's first volume. Refuses a function that depends on the voxels, which
 * are not read here. */
static hl_status read_of_scene(hl_json_reader *reader, const json_t *root, hl_transfer_function *function) {
  const json_t *volume = json_array_get(json_object_get(root, "volumes"), 0);
  const json_t *value = json_object_get(volume, "transfer_function");
  hl_json_enter(reader, "volumes/0/transfer_function");
  if (value == NULL || json_object_get(value, "preset") != NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL,
                        "the scene leaves its points to be chosen from the voxels: "
                        "write them, as 'halflight render SCENE --print-scene' does");
  return hl_json_read_transfer_function(reader, value, (hl_function_subject){.volume = NULL}, function);
}

static hl_status read_any(hl_json_reader *reader, const json_t *root, const hl_volume *volume,
                          hl_transfer_function *function) {
  if (json_is_array(root)) return hl_json_read_paraview(reader, root, function);
  if (json_object_get(root, "volumes") != NULL) return read_of_scene(reader, root, function);
  if (json_object_get(root, "volumeProperties") != NULL)
    return hl_json_read_slicer(reader, root, volume, function);
  return hl_json_read_transfer_function(reader, root, (hl_function_subject){.volume = NULL}, function);
}

/* Reads a transfer function from a JSON file. *by_voxel: whether the file gives gradients per voxel edge, as
 * Slicer does. */
static hl_status load_json(hl_json_reader *reader, const char *path, const hl_volume *volume, bool *by_voxel,
                           hl_transfer_function *function) {
  unsigned char *bytes = NULL;
  size_t length = 0;
  json_t *root = NULL;
  hl_status status = hl_file_read(reader->context, path, HL_JSON_LIMIT, &bytes, &length, reader->error);
  if (status != HL_OK) return status;
  status = hl_json_parse((const char *)bytes, length, path, &root, reader->error);
  if (status == HL_OK) status = read_any(reader, root, volume, function);
  *by_voxel = json_object_get(root, "volumeProperties") != NULL;
  json_decref(root);
  hl_release(reader->context, bytes);
  return status;
}

static hl_status load(hl_json_reader *reader, const char *path, const hl_volume *volume,
                      hl_transfer_function *function) {
  bool by_voxel = hl_slicer_is_text(path);
  hl_status status = HL_OK;
  if (by_voxel) status = hl_slicer_read_text(reader->context, path, function, reader->error);
  else if (hl_text_ends(path, ".pvsm"))
    status = hl_paraview_read_state(reader->context, path, volume, function, reader->error);
  else status = load_json(reader, path, volume, &by_voxel, function);
  if (status != HL_OK) return status;
  if (by_voxel && volume != NULL) hl_slicer_fit_gradient(volume, function);
  status = hl_transfer_function_check(function, "", reader->error);
  if (status != HL_OK) hl_json_prefix(reader, NULL);
  return status;
}

hl_status hl_transfer_function_load_for(hl_context *context, const char *path, const hl_volume *volume,
                                        hl_transfer_function *function, hl_error *error) {
  HL_DOOR;
  if (context == NULL || path == NULL || function == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_transfer_function_load_for: null context, path or function");
  hl_json_reader reader = {.context = context, .name = path, .error = error};
  hl_transfer_function made = {.unit_distance = 1};
  hl_status status = load(&reader, path, volume, &made);
  if (status != HL_OK) hl_transfer_function_release(context, &made);
  else *function = made;
  return status;
}

hl_status hl_transfer_function_load(hl_context *context, const char *path, hl_transfer_function *function,
                                    hl_error *error) {
  HL_DOOR;
  return hl_transfer_function_load_for(context, path, NULL, function, error);
}
