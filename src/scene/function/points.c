/* scene/function/points.c - see points.h. */
#include "scene/function/points.h"

#include <math.h>
#include <string.h>

size_t hl_points_not_above(const void *points, size_t count, size_t stride, double value) {
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

double hl_points_opacity(const hl_opacity_point *points, size_t count, double value) {
  size_t after = hl_points_not_above(points, count, sizeof *points, value);
  if (after == 0) return points[0].opacity;
  if (after == count) return points[after - 1].opacity;
  const hl_opacity_point *a = &points[after - 1], *b = &points[after];
  double t = (value - a->value) / (b->value - a->value);
  return a->opacity + t * (b->opacity - a->opacity);
}

void hl_points_color(const hl_color_point *points, size_t count, double value, double color[3]) {
  if (count == 0) {
    color[0] = color[1] = color[2] = 1;
    return;
  }
  size_t after = isnan(value) ? 0 : hl_points_not_above(points, count, sizeof *points, value);
  if (after == 0 || after == count) {
    memcpy(color, points[after == 0 ? 0 : count - 1].color, 3 * sizeof *color);
    return;
  }
  const hl_color_point *a = &points[after - 1], *b = &points[after];
  double t = (value - a->value) / (b->value - a->value);
  for (int channel = 0; channel < 3; channel++)
    color[channel] = a->color[channel] + t * (b->color[channel] - a->color[channel]);
}
