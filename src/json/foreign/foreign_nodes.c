/* json/foreign/foreign_nodes.c - converts the points of other programs' transfer functions to Halflight's.
 *
 * The colours of these points are sRGB and are mixed in a space that the file names. Halflight's points are
 * in linear RGB. They lie so close together that straight lines between them come near the file's mixing. */
#include "json/foreign/foreign_nodes.h"

#include <math.h>

#include "core/memory.h"
#include "elementary/elementary.h"
#include "scene/scene.h"

#define PIECES 16 /* number of straight pieces that a curved segment becomes */

/* The weight, from 0 to 1, of the next node's number between a node and the next node (vtkPiecewiseFunction).
 * t: the place between the two nodes, as a fraction of their distance. */
static double ease(double t, const hl_foreign_node *n) {
  if (n->midpoint == 0.5 && n->sharpness < 0.01) return t;
  t = t < n->midpoint ? 0.5 * t / n->midpoint : 0.5 + 0.5 * (t - n->midpoint) / (1 - n->midpoint);
  if (n->sharpness > 0.99) return t < 0.5 ? 0 : 1;
  if (n->sharpness < 0.01) return t;
  double power = 1 + 10 * n->sharpness;
  t = t < 0.5 ? 0.5 * hl_pow(2 * t, power) : 1 - 0.5 * hl_pow(2 * (1 - t), power);
  /* slope of the Hermite curve at both of its ends */
  double slope = 1 - n->sharpness, t2 = t * t, t3 = t2 * t;
  return (3 * t2 - 2 * t3) + slope * (2 * t3 - 3 * t2 + t);
}

hl_status hl_foreign_opacity(hl_context *context, const hl_foreign_node *nodes, size_t count,
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

hl_status hl_foreign_color(hl_context *context, const hl_foreign_node *nodes, size_t count,
                           hl_color_space space, hl_transfer_function *function, hl_error *error) {
  hl_color_point *points = hl_allocate(context, count * PIECES, sizeof *points);
  if (points == NULL) return hl_fail_memory(error, count * PIECES * sizeof *points, "a transfer function");
  size_t made = 0;
  for (size_t n = 0; n < count; n++) {
    bool last = n + 1 == count || nodes[n + 1].value == nodes[n].value;
    bool step = space == HL_SPACE_STEP && !last; /* a step becomes two points at one value */
    for (int piece = 0; piece < (last ? 1 : step ? 2 : PIECES); piece++) {
      double t = step ? 0 : piece / (double)PIECES, srgb[3], end = last ? nodes[n].value : nodes[n + 1].value;
      hl_color_mix(space, nodes[n].y, last ? nodes[n].y : nodes[n + 1].y, step ? piece : ease(t, &nodes[n]),
                   srgb);
      hl_color_point *point = &points[made++];
      point->value = nodes[n].value + t * (end - nodes[n].value);
      for (int c = 0; c < 3; c++) point->color[c] = hl_srgb_decode(fmin(fmax(srgb[c], 0), 1));
    }
  }
  function->color = points;
  function->color_count = made;
  return HL_OK;
}

hl_status hl_foreign_check(hl_json_reader *reader, const hl_foreign_node *nodes, size_t count) {
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
