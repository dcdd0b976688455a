/* scene/transfer_function.c - what a transfer function says about one value, and about a range of values.
 *
 * Piecewise linear in data values, constant beyond the end points. Two points at one value make a step,
 * which is continuous from above: at the value itself the second point holds.
 */
#include <string.h>

#include "core/memory.h"
#include "scene/scene.h"

/* The number of points whose value is <= value; points are spaced by stride bytes and begin with their
 * value. */
static size_t count_not_above(const void *points, size_t count, size_t stride, double value) {
  size_t low = 0, high = count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    double at;
    memcpy(&at, (const char *)points + middle * stride, sizeof at);
    if (at <= value) low = middle + 1;
    else high = middle;
  }
  return low;
}

double hl_transfer_function_opacity(const hl_transfer_function *function, double value) {
  const hl_opacity_point *points = function->opacity;
  if (function->opacity_count == 0 || isnan(value)) return 0;
  size_t after = count_not_above(points, function->opacity_count, sizeof *points, value);
  if (after == 0) return points[0].opacity;
  if (after == function->opacity_count) return points[after - 1].opacity;
  const hl_opacity_point *a = &points[after - 1], *b = &points[after];
  double t = (value - a->value) / (b->value - a->value);
  return a->opacity + t * (b->opacity - a->opacity);
}

void hl_transfer_function_color(const hl_transfer_function *function, double value, double color[3]) {
  const hl_color_point *points = function->color;
  size_t count = function->color_count;
  if (count == 0) {
    color[0] = color[1] = color[2] = 1;
    return;
  }
  size_t after = isnan(value) ? 0 : count_not_above(points, count, sizeof *points, value);
  if (after == 0 || after == count) {
    memcpy(color, points[after == 0 ? 0 : count - 1].color, 3 * sizeof *color);
    return;
  }
  const hl_color_point *a = &points[after - 1], *b = &points[after];
  double t = (value - a->value) / (b->value - a->value);
  for (int channel = 0; channel < 3; channel++)
    color[channel] = a->color[channel] + t * (b->color[channel] - a->color[channel]);
}

int hl_transfer_function_visible(const hl_transfer_function *function, double low, double high) {
  const hl_opacity_point *points = function->opacity;
  if (!(low <= high)) return 0;
  if (hl_transfer_function_opacity(function, low) > 0 || hl_transfer_function_opacity(function, high) > 0)
    return 1;
  /* Both ends are transparent: linear pieces between can only rise at a point inside, both points of a step
   * counted. */
  for (size_t p = count_not_above(points, function->opacity_count, sizeof *points, low);
       p < function->opacity_count && points[p].value <= high; p++)
    if (points[p].opacity > 0) return 1;
  return 0;
}

/* The set of transparent values is made of intervals whose ends are points of the function, the end itself
 * left out where a step rises there. So the points, the values just below them, the range's ends and the
 * target are the candidates. */
bool hl_transfer_function_transparent(const hl_transfer_function *function, double low, double high,
                                      double target, double *nearest) {
  double candidates[3] = {target, low, high}, best = INFINITY;
  size_t first = count_not_above(function->opacity, function->opacity_count, sizeof *function->opacity, low);
  for (size_t c = 0; c < 3 + 2 * (function->opacity_count - first); c++) {
    double value = c < 3 ? candidates[c] : function->opacity[first + (c - 3) / 2].value;
    if (c >= 3 && c % 2 == 0) value = nextafter(value, -INFINITY);
    if (value < low) continue;
    if (value > high) break;
    if (fabs(value - target) >= best || hl_transfer_function_opacity(function, value) > 0) continue;
    best = fabs(value - target);
    *nearest = value;
  }
  return best < INFINITY;
}

void hl_transfer_function_release(hl_context *context, hl_transfer_function *function) {
  if (context == NULL || function == NULL) return;
  hl_release(context, (void *)function->opacity);
  hl_release(context, (void *)function->color);
  *function = (hl_transfer_function){0};
}
