/* json/foreign/slicer.c - reads volume properties that 3D Slicer has saved in JSON (.vp.json): for each
 * component of the voxels, the opacity by value, the opacity by gradient, and the colour. Shade and lighting
 * are ignored, because the scene has its own light. */
#include "json/foreign/slicer.h"

#include <stdio.h>

#include "core/memory.h"
#include "core/vector.h"
#include "json/foreign/foreign_nodes.h"
#include "scene/function/transfer_function.h"
#include "volume/io/text.h"
#include "volume/volume.h"

enum { MOST_COMPONENTS = 4 }; /* the value of VTK_MAX_VRCOMP */

/* Reads the points of a function as Slicer writes them: [{"x": value, "y": opacity or "color": [r, g, b],
 * "midpoint": .5, "sharpness": 0}, ...] */
static hl_status read_points(hl_json_reader *reader, const json_t *component, const char *key, bool colors,
                             hl_foreign_node **nodes, size_t *count) {
  const json_t *function = json_object_get(component, key), *points = json_object_get(function, "points");
  size_t mark = hl_json_enter(reader, key);
  if (points == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "points", "is missing: give the function's points");
  hl_json_enter(reader, "points");
  hl_status status = hl_json_array(reader, points, 1, HL_FOREIGN_NODES);
  if (status != HL_OK) return status;
  *count = json_array_size(points);
  *nodes = hl_allocate_zeroed(reader->context, *count, sizeof **nodes);
  if (*nodes == NULL) return hl_fail_memory(reader->error, *count * sizeof **nodes, "a transfer function");
  for (size_t n = 0; status == HL_OK && n < *count; n++) {
    const json_t *point = json_array_get(points, n);
    hl_foreign_node *made = &(*nodes)[n];
    size_t inner = hl_json_enter_index(reader, n);
    made->midpoint = 0.5;
    if (json_object_get(point, "x") == NULL || json_object_get(point, colors ? "color" : "y") == NULL)
      return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "has no x or no %s: give both",
                          colors ? "color" : "y");
    status = hl_json_number(reader, point, "x", &made->value);
    if (status == HL_OK && colors) status = hl_json_numbers(reader, point, "color", 3, made->y);
    if (status == HL_OK && !colors) status = hl_json_number(reader, point, "y", &made->y[0]);
    if (status == HL_OK) status = hl_json_number(reader, point, "midpoint", &made->midpoint);
    if (status == HL_OK) status = hl_json_number(reader, point, "sharpness", &made->sharpness);
    if (status == HL_OK) hl_json_leave(reader, inner);
  }
  if (status == HL_OK) status = hl_foreign_check(reader, *nodes, *count);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

/* Reads a component's function of opacity. */
static hl_status read_opacity(hl_json_reader *reader, const json_t *component, const char *key,
                              const hl_opacity_point **opacity, size_t *opacity_count) {
  hl_foreign_node *nodes = NULL;
  size_t count = 0;
  hl_status status = read_points(reader, component, key, false, &nodes, &count);
  if (status == HL_OK)
    status = hl_foreign_opacity(reader->context, nodes, count, opacity, opacity_count, reader->error);
  hl_release(reader->context, nodes);
  return status;
}

void hl_slicer_drop_even_gradient(hl_context *context, hl_transfer_function *function) {
  for (size_t p = 0; p < function->gradient_opacity_count; p++)
    if (function->gradient_opacity[p].opacity != 1) return;
  hl_release(context, (void *)function->gradient_opacity);
  function->gradient_opacity = NULL;
  function->gradient_opacity_count = 0;
}

void hl_slicer_fit_gradient(const hl_volume *volume, hl_transfer_function *function) {
  hl_opacity_point *points = (hl_opacity_point *)function->gradient_opacity;
  double edges = 0, most = (volume->maximum - volume->minimum) / 4;
  size_t count = function->gradient_opacity_count, kept = 0;
  if (count == 0) return;
  double held = hl_transfer_function_gradient_opacity(function, most);
  for (int axis = 0; axis < 3; axis++) edges += vec3_length(mat3_column(volume->index_to_world.linear, axis));
  while (kept < count && points[kept].value < most) kept++;
  if (kept < count) points[kept++] = (hl_opacity_point){most, held};
  for (size_t p = 0; p < kept; p++) points[p].value /= edges / 3;
  function->gradient_opacity_count = kept;
}

/* Reads opacity by gradient, if the preset has such a function and uses it. Opacity that is 1 for all
 * gradients is left out. */
static hl_status read_gradient(hl_json_reader *reader, const json_t *component,
                               hl_transfer_function *function) {
  if (json_is_true(json_object_get(component, "disableGradientOpacity")) ||
      json_object_get(component, "gradientOpacity") == NULL)
    return HL_OK;
  hl_status status = read_opacity(reader, component, "gradientOpacity", &function->gradient_opacity,
                                  &function->gradient_opacity_count);
  if (status == HL_OK) hl_slicer_drop_even_gradient(reader->context, function);
  return status;
}

static hl_status refuse_nearest(hl_json_reader *reader, const json_t *properties) {
  const char *text = json_string_value(json_object_get(properties, "interpolationType"));
  if (text == NULL || !hl_text_starts(text, "nearest")) return HL_OK;
  return hl_json_fail(reader, HL_ERROR_UNSUPPORTED, NULL,
                      "interpolationType %s is not supported: set it to linear", text);
}

/* The number of components that each voxel has in the volume's file. *read: receives the number of the
 * component that was read; it is negative if several components were read. Channels count as components; the
 * time steps of a series do not. */
static size_t components_of(const hl_volume *volume, int *read) {
  const hl_selection *of = &volume->selection;
  bool series = of->times > 1 || of->channels > 1;
  *read = series ? of->channel : volume->component;
  return series                    ? of->channels
         : volume->array_count > 0 ? volume->arrays[volume->chosen_array].components
                                   : 1;
}

/* Finds the component of the preset whose functions are used for a volume: the component that was read from
 * the volume's file. If this file has one component, the preset's first one is chosen, as in Slicer. volume:
 * may be null if the preset has a single component. */
static hl_status choose_component(hl_json_reader *reader, size_t count, const hl_volume *volume,
                                  size_t *chosen) {
  int read = 0;
  *chosen = 0;
  if (count == 1) return HL_OK;
  if (volume == NULL)
    return hl_json_fail(
        reader, HL_ERROR_INPUT, NULL,
        "has %zu entries: load the file for a volume, whose component tells which of them is meant", count);
  if (components_of(volume, &read) == 1) return HL_OK;
  if (read < 0 || (size_t)read >= count) {
    char number[16];
    snprintf(number, sizeof number, "%d", read);
    return hl_json_fail(
        reader, HL_ERROR_INPUT, NULL,
        "has %zu entries, and none of them is for component %s of the volume: give a \"component\" "
        "from 0 to %zu, and a volume for each that is to be shown",
        count, read < 0 ? hl_component_name(read) : number, count - 1);
  }
  *chosen = (size_t)read;
  return HL_OK;
}

/* Refuses presets that mix components or weight them, because Halflight gives each component its full
 * opacity. */
static hl_status refuse_mixing(hl_json_reader *reader, const json_t *properties, const json_t *components) {
  if (json_array_size(components) < 2) return HL_OK;
  if (json_is_false(json_object_get(properties, "independentComponents")))
    return hl_json_fail(
        reader, HL_ERROR_UNSUPPORTED, NULL,
        "components that depend on each other (independentComponents is false) are not supported: set it to "
        "true, or show colours by \"component\": \"color\"");
  for (size_t n = 0; n < json_array_size(components); n++) {
    size_t mark = hl_json_enter_index(reader, n);
    double weight = 1;
    hl_status status = hl_json_number(reader, json_array_get(components, n), "componentWeight", &weight);
    if (status == HL_OK && weight != 1)
      status = hl_json_fail(reader, HL_ERROR_UNSUPPORTED, "componentWeight",
                            "%.9g is not supported: set it to 1, and lower the opacities", weight);
    if (status != HL_OK) return status;
    hl_json_leave(reader, mark);
  }
  return HL_OK;
}

static hl_status read_component(hl_json_reader *reader, const json_t *component,
                                hl_transfer_function *function) {
  hl_foreign_node *nodes = NULL;
  size_t count = 0;
  hl_status status = hl_json_number(reader, component, "scalarOpacityUnitDistance", &function->unit_distance);
  if (status == HL_OK)
    status = read_opacity(reader, component, "scalarOpacity", &function->opacity, &function->opacity_count);
  if (status == HL_OK) status = read_points(reader, component, "rgbTransferFunction", true, &nodes, &count);
  if (status == HL_OK)
    status = hl_foreign_color(reader->context, nodes, count, HL_SPACE_RGB, function, reader->error);
  hl_release(reader->context, nodes);
  return status == HL_OK ? read_gradient(reader, component, function) : status;
}

hl_status hl_json_read_slicer(hl_json_reader *reader, const json_t *root, const hl_volume *volume,
                              hl_transfer_function *function) {
  size_t chosen = 0;
  hl_json_enter(reader, "volumeProperties");
  const json_t *properties = json_object_get(root, "volumeProperties");
  hl_status status = hl_json_array(reader, properties, 1, 1);
  if (status != HL_OK) return status;
  hl_json_enter(reader, "0/components");
  properties = json_array_get(properties, 0);
  const json_t *components = json_object_get(properties, "components");
  status = hl_json_array(reader, components != NULL ? components : json_null(), 1, MOST_COMPONENTS);
  if (status == HL_OK) status = refuse_nearest(reader, properties);
  if (status == HL_OK) status = refuse_mixing(reader, properties, components);
  if (status == HL_OK) status = choose_component(reader, json_array_size(components), volume, &chosen);
  if (status != HL_OK) return status;
  hl_json_enter_index(reader, chosen);
  return read_component(reader, json_array_get(components, chosen), function);
}
