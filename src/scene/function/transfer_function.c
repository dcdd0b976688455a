/* scene/function/transfer_function.c - evaluates a transfer function at a value and over a range of values,
 * by the rules of points.h. */
#include "scene/function/transfer_function.h"
#include <math.h>
#include <string.h>
#include "core/door.h"
#include "core/memory.h"
#include "scene/function/function_plane.h"
#include "scene/function/points.h"
#include "text/edit_distance.h"

double hl_transfer_function_opacity(const hl_transfer_function *function, double value) {
  if (function->opacity_count == 0 || isnan(value)) return 0;
  return hl_points_opacity(function->opacity, function->opacity_count, value);
}

/* Derived: the difference of two opacities is linear in both values, as long as each value stays between the
 * same two points. So the difference is greatest where both values are points, or where one value is a point
 * and the other value lies `reach` beside this point. */
double hl_transfer_function_opacity_change(const hl_transfer_function *function, double reach) {
  const hl_opacity_point *points = function->opacity;
  double most = 0;
  if (!(reach > 0)) return reach == 0 ? 0 : NAN;
  for (size_t n = 0; n < function->opacity_count; n++) {
    const double value = points[n].value, opacity = points[n].opacity;
    for (int side = -1; side <= 1; side += 2)
      most = fmax(most, fabs(hl_transfer_function_opacity(function, value + side * reach) - opacity));
    for (size_t other = n; other-- > 0 && points[other].value >= value - reach;)
      most = fmax(most, fabs(points[other].opacity - opacity));
  }
  return most;
}

double hl_transfer_function_gradient_opacity(const hl_transfer_function *function, double gradient) {
  if (function->gradient_opacity_count == 0) return 1;
  return hl_points_opacity(function->gradient_opacity, function->gradient_opacity_count, gradient);
}

void hl_transfer_function_color(const hl_transfer_function *function, double value, double color[3]) {
  hl_points_color(function->color, function->color_count, value, color);
}

int hl_transfer_function_visible(const hl_transfer_function *function, double low, double high) {
  const hl_opacity_point *points = function->opacity;
  if (!(low <= high)) return 0;
  if (hl_transfer_function_opacity(function, low) > 0 || hl_transfer_function_opacity(function, high) > 0)
    return 1;
  /* both ends of the range are transparent, and the function is linear between points. So only points between
   * the ends need to be tested; both points of a step are tested */
  for (size_t p = hl_points_not_above(points, function->opacity_count, sizeof *points, low);
       p < function->opacity_count && points[p].value <= high; p++)
    if (points[p].opacity > 0) return 1;
  return 0;
}

/* Finds the nearest transparent value among a few candidates. Transparent values form intervals between
 * points of the function. If a step rises at the end of an interval, the end itself is not transparent. So
 * the candidates are the target, the range's ends, the points, and the values just below the points. */
bool hl_transfer_function_transparent(const hl_transfer_function *function, double low, double high,
                                      double target, double *nearest) {
  double candidates[3] = {target, low, high}, best = INFINITY;
  size_t first = hl_points_not_above(function->opacity, function->opacity_count, sizeof *function->opacity,
                                     low);
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
  hl_release(context, (void *)function->gradient_opacity);
  hl_plane_release(context, &function->plane);
  *function = (hl_transfer_function){0};
}

static hl_status fail_unknown(const char *name, hl_error *error) {
  const char *names[HL_COLORMAPS_MOST + 1];
  char mend[400];
  size_t index = 0;
  do names[index] = hl_colormap_name(index);
  while (names[index++] != NULL);
  hl_suggest_name(name, names, mend, sizeof mend);
  return hl_fail(error, HL_ERROR_INPUT, "unknown colormap \"%.80s\": %s", name, mend);
}

hl_status hl_transfer_function_colormap(hl_context *context, const char *name, double low, double high,
                                        hl_transfer_function *function, hl_error *error) {
  HL_DOOR;
  double ignored[3];
  if (context == NULL || name == NULL || function == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_transfer_function_colormap: null context, name or function");
  if (!hl_colormap_evaluate(name, 0, ignored)) return fail_unknown(name, error);
  if (!(low < high) || !isfinite(high - low))
    return hl_fail(error, HL_ERROR_INPUT, "colormap range %.9g to %.9g: give two values, the lower one first",
                   low, high);
  size_t count = HL_COLORMAP_POINTS;
  hl_color_point *points = hl_allocate(context, count, sizeof *points);
  if (points == NULL) return hl_fail_memory(error, count * sizeof *points, "a colormap");
  for (size_t p = 0; p < count; p++) {
    double t = (double)p / (double)(count - 1);
    points[p].value = p + 1 == count ? high : low + t * (high - low);
    hl_colormap_evaluate(name, t, points[p].color);
  }
  hl_release(context, (void *)function->color);
  function->color = points;
  function->color_count = count;
  return HL_OK;
}
