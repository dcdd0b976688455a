/* json/foreign_functions.c - transfer functions as other programs save them: ParaView's colour maps, Slicer's
 * presets.
 *
 * Their colours are sRGB, mixed in the space that the file names. They become points in linear RGB, so close
 * together that straight lines between them come near that mixing. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "json/color_space.h"
#include "json/parts.h"
#include "scene/scene.h"
#include "scene/transfer_function.h"

#define PIECES     16   /* straight pieces that a curved segment becomes */
#define MOST_NODES 2048 /* of a foreign function, whose pieces must stay below HL_LIMIT_POINTS */

/* A point of a foreign function: an opacity or an sRGB colour at a value. Midpoint and sharpness shape the
 * segment to the next point, as in VTK. */
typedef struct node {
  double value, y[3], midpoint, sharpness;
} node;

/* How far, from 0 to 1, the function has come from one node to the next at the fraction t of their distance
 * (vtkPiecewiseFunction). */
static double ease(double t, const node *n) {
  if (n->midpoint == 0.5 && n->sharpness < 0.01) return t;
  t = t < n->midpoint ? 0.5 * t / n->midpoint : 0.5 + 0.5 * (t - n->midpoint) / (1 - n->midpoint);
  if (n->sharpness > 0.99) return t < 0.5 ? 0 : 1;
  if (n->sharpness < 0.01) return t;
  double power = 1 + 10 * n->sharpness;
  t = t < 0.5 ? 0.5 * pow(2 * t, power) : 1 - 0.5 * pow(2 * (1 - t), power);
  double slope = 1 - n->sharpness, t2 = t * t, t3 = t2 * t; /* Hermite, with this slope at both ends */
  return (3 * t2 - 2 * t3) + slope * (2 * t3 - 3 * t2 + t);
}

/* Writes nodes as opacity points, owned by the caller. */
static hl_status make_opacity(hl_context *context, const node *nodes, size_t count,
                              const hl_opacity_point **opacity, size_t *opacity_count, hl_error *error) {
  hl_opacity_point *points = hl_allocate(context, count * PIECES, sizeof *points);
  if (points == NULL) return hl_fail_memory(error, count * PIECES * sizeof *points, "a transfer function");
  size_t made = 0;
  for (size_t n = 0; n < count; n++) {
    bool straight = n + 1 == count || (nodes[n].midpoint == 0.5 && nodes[n].sharpness < 0.01);
    for (int piece = 0; piece < (straight ? 1 : PIECES); piece++) {
      double t = piece / (double)PIECES, eased = ease(t, &nodes[n]);
      double y = nodes[n].y[0], next = straight ? y : nodes[n + 1].y[0],
             end = straight ? 0 : nodes[n + 1].value;
      points[made++] = (hl_opacity_point){
          straight ? nodes[n].value : nodes[n].value + t * (end - nodes[n].value),
          fmin(fmax(y + eased * (next - y), 0), 1)};
    }
  }
  *opacity = points;
  *opacity_count = made;
  return HL_OK;
}

/* Gradient opacity of 1 everywhere is none. */
static void drop_even_gradient(hl_context *context, hl_transfer_function *function) {
  for (size_t p = 0; p < function->gradient_opacity_count; p++)
    if (function->gradient_opacity[p].opacity != 1) return;
  hl_release(context, (void *)function->gradient_opacity);
  function->gradient_opacity = NULL;
  function->gradient_opacity_count = 0;
}

/* Writes nodes as colour points. */
static hl_status set_color(hl_context *context, const node *nodes, size_t count, hl_color_space space,
                           hl_transfer_function *function, hl_error *error) {
  hl_color_point *points = hl_allocate(context, count * PIECES, sizeof *points);
  if (points == NULL) return hl_fail_memory(error, count * PIECES * sizeof *points, "a transfer function");
  size_t made = 0;
  for (size_t n = 0; n < count; n++) {
    bool last = n + 1 == count || nodes[n + 1].value == nodes[n].value;
    bool step = space == HL_SPACE_STEP && !last; /* two points at one value */
    for (int piece = 0; piece < (last ? 1 : step ? 2 : PIECES); piece++) {
      double t = step ? 0 : piece / (double)PIECES, srgb[3], end = last ? nodes[n].value : nodes[n + 1].value;
      hl_color_mix(space, nodes[n].y, last ? nodes[n].y : nodes[n + 1].y, step ? piece : ease(t, &nodes[n]),
                   srgb);
      hl_color_point *point = &points[made++];
      point->value = nodes[n].value + t * (end - nodes[n].value);
      for (int c = 0; c < 3; c++) point->color[c] = hl_srgb_to_linear(fmin(fmax(srgb[c], 0), 1));
    }
  }
  function->color = points;
  function->color_count = made;
  return HL_OK;
}

/* Checks a foreign function here, where errors can name its own points. */
static hl_status check_nodes(hl_json_reader *reader, const node *nodes, size_t count) {
  for (size_t n = 0; n < count; n++) {
    if (n > 0 && nodes[n].value < nodes[n - 1].value)
      return hl_json_fail(reader, HL_ERROR_INPUT, NULL,
                          "point %zu: %.9g comes after %.9g: sort the points by value", n, nodes[n].value,
                          nodes[n - 1].value);
    if (nodes[n].midpoint > 0 && nodes[n].midpoint < 1 && nodes[n].sharpness >= 0 && nodes[n].sharpness <= 1)
      continue;
    return hl_json_fail(
        reader, HL_ERROR_INPUT, NULL,
        "point %zu: midpoint %.9g and sharpness %.9g: give numbers from 0 to 1, the midpoint inside", n,
        nodes[n].midpoint, nodes[n].sharpness);
  }
  return HL_OK;
}

/* ParaView: one flat array of four numbers per point: value, red, green, blue (ordinates 3), or value,
 * opacity, midpoint, sharpness (ordinates 1). */
static hl_status read_flat(hl_json_reader *reader, const json_t *map, const char *key, size_t ordinates,
                           node **nodes, size_t *count) {
  const json_t *value = json_object_get(map, key);
  size_t mark = hl_json_enter(reader, key);
  hl_status status = hl_json_array(reader, value, 4, 4 * MOST_NODES);
  if (status != HL_OK) return status;
  if (json_array_size(value) % 4 != 0)
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "has %zu numbers: give groups of four",
                        json_array_size(value));
  *count = json_array_size(value) / 4;
  *nodes = hl_allocate(reader->context, *count, sizeof **nodes);
  if (*nodes == NULL) return hl_fail_memory(reader->error, *count * sizeof **nodes, "a transfer function");
  for (size_t n = 0; n < *count; n++) {
    double row[4];
    for (size_t e = 0; e < 4; e++) {
      const json_t *element = json_array_get(value, 4 * n + e);
      if (!json_is_number(element)) {
        hl_json_enter_index(reader, 4 * n + e);
        return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "is no number: give one");
      }
      row[e] = json_number_value(element);
    }
    (*nodes)[n] = ordinates == 3 ? (node){row[0], {row[1], row[2], row[3]}, 0.5, 0}
                                 : (node){row[0], {row[1]}, row[2], row[3]};
  }
  status = check_nodes(reader, *nodes, *count);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

static const char *const space_names[] = {"RGB", "HSV", "Lab", "Diverging", "Step", NULL};

hl_status hl_json_read_paraview(hl_json_reader *reader, const json_t *root, hl_transfer_function *function) {
  hl_status status = hl_json_array(reader, root, 1, 1);
  if (status != HL_OK) return status;
  hl_json_enter_index(reader, 0);
  const json_t *map = json_array_get(root, 0);
  int space = HL_SPACE_RGB;
  double logarithmic = 0;
  node *nodes = NULL;
  size_t count = 0;
  if (!json_is_object(map) || json_object_get(map, "RGBPoints") == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "RGBPoints", "is missing: a ParaView colour map needs it");
  const char *name = json_string_value(json_object_get(map, "ColorSpace"));
  if (name != NULL && strcmp(name, "CIELAB") == 0) space = HL_SPACE_LAB;
  else status = hl_json_choice(reader, map, "ColorSpace", space_names, 0, &space);
  if (status == HL_OK) status = hl_json_number(reader, map, "UseLogScale", &logarithmic);
  if (status == HL_OK && logarithmic != 0)
    status = hl_json_fail(reader, HL_ERROR_UNSUPPORTED, "UseLogScale",
                          "logarithmic colour maps are not supported: save the map with a linear scale");
  if (status == HL_OK) status = read_flat(reader, map, "RGBPoints", 3, &nodes, &count);
  if (status == HL_OK)
    status = set_color(reader->context, nodes, count, (hl_color_space)space, function, reader->error);
  hl_release(reader->context, nodes);
  nodes = NULL;
  if (status == HL_OK && json_object_get(map, "Points") != NULL) {
    status = read_flat(reader, map, "Points", 1, &nodes, &count);
    if (status == HL_OK)
      status = make_opacity(reader->context, nodes, count, &function->opacity, &function->opacity_count,
                            reader->error);
    hl_release(reader->context, nodes);
  }
  return status;
}

/* Slicer: [{"x": value, "y": opacity or "color": [r, g, b], "midpoint": .5, "sharpness": 0}, ...] */
static hl_status read_points(hl_json_reader *reader, const json_t *component, const char *key, bool colors,
                             node **nodes, size_t *count) {
  const json_t *function = json_object_get(component, key), *points = json_object_get(function, "points");
  size_t mark = hl_json_enter(reader, key);
  if (points == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "points", "is missing: give the function's points");
  hl_json_enter(reader, "points");
  hl_status status = hl_json_array(reader, points, 1, MOST_NODES);
  if (status != HL_OK) return status;
  *count = json_array_size(points);
  *nodes = hl_allocate_zeroed(reader->context, *count, sizeof **nodes);
  if (*nodes == NULL) return hl_fail_memory(reader->error, *count * sizeof **nodes, "a transfer function");
  for (size_t n = 0; status == HL_OK && n < *count; n++) {
    const json_t *point = json_array_get(points, n);
    node *made = &(*nodes)[n];
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
  if (status == HL_OK) status = check_nodes(reader, *nodes, *count);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

/* Reads a component's function of opacity. */
static hl_status read_opacity(hl_json_reader *reader, const json_t *component, const char *key,
                              const hl_opacity_point **opacity, size_t *opacity_count) {
  node *nodes = NULL;
  size_t count = 0;
  hl_status status = read_points(reader, component, key, false, &nodes, &count);
  if (status == HL_OK)
    status = make_opacity(reader->context, nodes, count, opacity, opacity_count, reader->error);
  hl_release(reader->context, nodes);
  return status;
}

/* Opacity by gradient, where the preset has some and it changes anything. */
static hl_status read_gradient(hl_json_reader *reader, const json_t *component,
                               hl_transfer_function *function) {
  if (json_is_true(json_object_get(component, "disableGradientOpacity")) ||
      json_object_get(component, "gradientOpacity") == NULL)
    return HL_OK;
  hl_status status = read_opacity(reader, component, "gradientOpacity", &function->gradient_opacity,
                                  &function->gradient_opacity_count);
  if (status == HL_OK) drop_even_gradient(reader->context, function);
  return status;
}

hl_status hl_json_read_slicer(hl_json_reader *reader, const json_t *root, hl_transfer_function *function) {
  hl_json_enter(reader, "volumeProperties");
  const json_t *properties = json_object_get(root, "volumeProperties");
  hl_status status = hl_json_array(reader, properties, 1, 1);
  if (status != HL_OK) return status;
  hl_json_enter(reader, "0/components");
  const json_t *components = json_object_get(json_array_get(properties, 0), "components");
  status = hl_json_array(reader, components != NULL ? components : json_null(), 1, 16);
  if (status != HL_OK) return status;
  hl_json_enter_index(reader, 0);
  const json_t *component = json_array_get(components, 0);
  node *nodes = NULL;
  size_t count = 0;
  status = hl_json_number(reader, component, "scalarOpacityUnitDistance", &function->unit_distance);
  if (status == HL_OK)
    status = read_opacity(reader, component, "scalarOpacity", &function->opacity, &function->opacity_count);
  if (status == HL_OK) status = read_points(reader, component, "rgbTransferFunction", true, &nodes, &count);
  if (status == HL_OK)
    status = set_color(reader->context, nodes, count, HL_SPACE_RGB, function, reader->error);
  hl_release(reader->context, nodes);
  return status == HL_OK ? read_gradient(reader, component, function) : status;
}
