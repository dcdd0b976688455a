/* scene/function/spread.c - moves a transfer function's points to another range of values, evenly or by
 * logarithms.
 *
 * Let t go from 0 to 1 over the old range. Evenly, a point at t moves to low + t (high - low); by logarithms,
 * the point moves to low (high / low)^t. Logarithms make curves of the straight lines between points. So for
 * logarithms each line is divided at the multiples of 1/PIECES of t. */
#include <math.h>
#include <string.h>

#include "core/door.h"
#include "core/memory.h"
#include "elementary/elementary.h"
#include "scene/function/transfer_function.h"

/* The number of pieces into which the range is divided. With d = ln(high / low) / PIECES, a straight piece
 * differs from the logarithm by at most d^2 / 8 (derived: a chord's distance from a logarithm). As a fraction
 * of ln(high / low), the difference is 4e-4 for six decades. */
enum { PIECES = 64 };

hl_status hl_transfer_function_visible_range(const hl_volume *volume, const hl_transfer_function *function,
                                             double range[2], hl_error *error) {
  HL_DOOR;
  hl_volume_info info = {.struct_size = sizeof info};
  if (function == NULL || range == NULL || hl_volume_get_info(volume, &info) != HL_OK)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_transfer_function_visible_range: null volume, function or range");
  range[0] = 0;
  range[1] = 1;
  if (info.range[0] < info.range[1]) memcpy(range, info.range, sizeof info.range);
  const hl_opacity_point *points = function->opacity;
  size_t count = function->opacity_count, first = 0, last = count;
  while (first < count && points[first].opacity <= 0) first++;
  while (last > first && points[last - 1].opacity <= 0) last--;
  if (first == last) return HL_OK; /* without a visible point, the result is the whole range of values */
  double low = first > 0 ? points[first - 1].value : range[0];
  double high = last < count ? points[last].value : range[1];
  if (low > range[0] && low < range[1]) range[0] = low;
  if (high > range[0] && high < range[1]) range[1] = high;
  return HL_OK;
}

/* The range of values that a transfer function grades. In pictures with light, the graded range is the
 * visible range. In a maximum projection, where opacity only decides whether a value counts, the graded range
 * goes from the value of the first colour to the value of the last colour. If these two values are equal, the
 * graded range is the visible range. */
static hl_status graded_range(const hl_volume *volume, const hl_transfer_function *function, bool projected,
                              double range[2], hl_error *error) {
  const size_t count = function->color_count;
  if (!projected || count < 2 || !(function->color[0].value < function->color[count - 1].value))
    return hl_transfer_function_visible_range(volume, function, range, error);
  range[0] = function->color[0].value;
  range[1] = function->color[count - 1].value;
  return HL_OK;
}

/* Points of opacity or colour, as rows of `width` numbers that begin with the value. */
typedef struct rows {
  const double *from; /* [count][width]; the given points */
  size_t count, width;
  double hinge; /* a value that keeps its place, evenly spread: each side is moved by itself; NAN if there is
                 * none */
  double *to;   /* [made][width]; the new points */
  size_t made;
} rows;

/* Appends the row a + f (b - a), which lies between the rows a and b. The new row begins with t, a position
 * in the old range, in place of a value. */
static void add_row(rows *r, const double *a, const double *b, double f, double t) {
  double *row = r->to + r->made++ * r->width;
  row[0] = t;
  for (size_t n = 1; n < r->width; n++) row[n] = f <= 0 ? a[n] : f >= 1 ? b[n] : a[n] + f * (b[n] - a[n]);
}

/* The place of a row's value in the old range, from 0 to 1. A place very close to a multiple of 1/PIECES
 * becomes this multiple, so that rounding makes no tiny pieces. */
static double place_of(const double *row, const double old[2]) {
  double t = (row[0] - old[0]) / (old[1] - old[0]), whole = round(t * PIECES);
  return fabs(t * PIECES - whole) < 1e-9 ? whole / PIECES : t;
}

/* Appends points of the line from row a to the next row, as far as their places t in the old range lie
 * between 0 and 1. The line's last point is left out, because the next line begins with it. */
static void add_line(rows *r, size_t a, const double old[2]) {
  const double *row = r->from + a * r->width, *next = row + r->width;
  double start = place_of(row, old), end = place_of(next, old);
  if (start >= 0 && start <= 1) add_row(r, row, row, 0, start);
  for (int piece = 0; piece <= PIECES; piece++) {
    double t = (double)piece / PIECES;
    if (t > start && t < end) add_row(r, row, next, (t - start) / (end - start), t);
  }
}

/* Appends all lines between points, divided into pieces, as far as their places t in the old range lie
 * between 0 and 1. At least one row is appended. */
static void divide_rows(rows *r, const double old[2]) {
  const double *first = r->from, *last = r->from + (r->count - 1) * r->width;
  double start = place_of(first, old), end = place_of(last, old);
  if (start > 1) add_row(r, first, first, 0, 1);
  for (size_t a = 0; a + 1 < r->count; a++) add_line(r, a, old);
  if (end >= 0 && end <= 1) add_row(r, last, last, 0, end);
  if (end < 0) add_row(r, last, last, 0, 0);
}

/* The place to which evenly spread values move. */
static double moved(double value, double hinge, const double old[2], const double range[2]) {
  if (isnan(hinge)) return range[0] + (value - old[0]) * ((range[1] - range[0]) / (old[1] - old[0]));
  const int side = value > hinge;
  return hinge + (value - hinge) * ((range[side] - hinge) / (old[side] - hinge));
}

/* Moves points to the new range of values. *to: receives the new rows (hl_release); *made: receives their
 * number. */
static hl_status spread_rows(hl_context *context, rows *r, const double old[2], const double range[2],
                             hl_range_scale scale, hl_error *error) {
  if (r->count == 0) return HL_OK;
  size_t most = scale == HL_RANGE_LOG ? r->count + PIECES + 2 : r->count;
  r->to = hl_allocate(context, most * r->width, sizeof *r->to);
  if (r->to == NULL) return hl_fail_memory(error, most * r->width * sizeof *r->to, "a transfer function");
  if (scale == HL_RANGE_LINEAR) {
    memcpy(r->to, r->from, r->count * r->width * sizeof *r->to);
    r->made = r->count;
    for (size_t n = 0; n < r->made; n++)
      r->to[n * r->width] = moved(r->to[n * r->width], r->hinge, old, range);
    return HL_OK;
  }
  divide_rows(r, old);
  double length = hl_ln(range[1] / range[0]);
  for (size_t n = 0; n < r->made; n++) {
    double *value = &r->to[n * r->width];
    *value = *value <= 0 ? range[0] : *value >= 1 ? range[1] : range[0] * hl_exp(*value * length);
  }
  return HL_OK;
}

hl_range_scale hl_transfer_function_scale(const hl_transfer_function *function) {
  HL_DOOR;
  const size_t count = function != NULL ? function->color_count : 0;
  if (count < PIECES + 1 || !(function->color[0].value > 0)) return HL_RANGE_LINEAR;
  const double low = function->color[0].value, length = hl_ln(function->color[count - 1].value / low);
  size_t p = 0;
  for (int piece = 1; piece < PIECES; piece++) {
    while (p + 1 < count && hl_ln(function->color[p].value / low) * PIECES < (piece - 1e-6) * length) p++;
    if (hl_ln(function->color[p].value / low) * PIECES > (piece + 1e-6) * length) return HL_RANGE_LINEAR;
  }
  return length > 0 ? HL_RANGE_LOG : HL_RANGE_LINEAR;
}

/* Moves all points to a new range. old: the values of colours that become the range's ends; held: the values
 * of opacities that do; hinge: the value that keeps its place, or NAN. */
static hl_status spread_all(hl_context *context, const hl_transfer_function *from, const double old[2],
                            const double held[2], double hinge, const double range[2], hl_range_scale scale,
                            hl_transfer_function *to, hl_error *error) {
  rows opacity = {
      .from = (const double *)from->opacity, .count = from->opacity_count, .width = 2, .hinge = hinge};
  rows color = {.from = (const double *)from->color, .count = from->color_count, .width = 4, .hinge = hinge};
  rows gradient = {.from = (const double *)from->gradient_opacity,
                   .count = from->gradient_opacity_count,
                   .width = 2,
                   .hinge = NAN};
  const double none[2] = {0, held[1] - held[0]}, widths[2] = {0, range[1] - range[0]};
  hl_status status = spread_rows(context, &opacity, held, range, scale, error);
  if (status == HL_OK) status = spread_rows(context, &color, old, range, scale, error);
  if (status == HL_OK) status = spread_rows(context, &gradient, none, widths, HL_RANGE_LINEAR, error);
  to->opacity = (hl_opacity_point *)opacity.to, to->opacity_count = opacity.made;
  to->color = (hl_color_point *)color.to, to->color_count = color.made;
  to->gradient_opacity = (hl_opacity_point *)gradient.to, to->gradient_opacity_count = gradient.made;
  return status;
}

_Static_assert(sizeof(hl_opacity_point) == 2 * sizeof(double), "opacity points are rows of two numbers");
_Static_assert(sizeof(hl_color_point) == 4 * sizeof(double), "colour points are rows of four numbers");

/* Spreads a function after checking the range. old, held, hinge: as for spread_all(). */
static hl_status spread_checked(hl_context *context, const hl_transfer_function *from, const double old[2],
                                const double held[2], double hinge, const double range[2],
                                hl_range_scale scale, hl_transfer_function *to, hl_error *error) {
  if (!(range[0] < range[1]) || !isfinite(range[1] - range[0]))
    return hl_fail(error, HL_ERROR_INPUT, "range %.9g to %.9g is empty: give two values, the lower one first",
                   range[0], range[1]);
  if (scale == HL_RANGE_LOG && !(range[0] > 0 && isfinite(range[1] / range[0]))) {
    const double high = range[1] > 0 ? range[1] : 1000;
    return hl_fail(error, HL_ERROR_INPUT,
                   "a logarithmic range must begin above 0, and %.9g to %.9g does not: give a range such as "
                   "%.3g to %.9g, or the linear scale",
                   range[0], range[1], high / 1000, high);
  }
  hl_transfer_function made = {.unit_distance = from->unit_distance};
  hl_status status = spread_all(context, from, old, held, hinge, range, scale, &made, error);
  if (status == HL_OK) *to = made;
  else hl_transfer_function_release(context, &made);
  return status;
}

hl_status hl_transfer_function_spread(hl_context *context, const hl_transfer_function *from,
                                      const double old[2], const double range[2], hl_range_scale scale,
                                      hl_transfer_function *to, hl_error *error) {
  HL_DOOR;
  if (context == NULL || from == NULL || old == NULL || range == NULL || to == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_transfer_function_spread: null argument");
  if (!(old[0] < old[1] && isfinite(old[1] - old[0])))
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_transfer_function_spread: the old range is empty");
  return spread_checked(context, from, old, old, NAN, range, scale, to, error);
}

/* Widens a function's visible range where clear values are to keep their place: the range's end moves to the
 * end of the new range, but not beyond the volume's values. all: the range of the volume's values. mapped:
 * whether a colormap is given; the new range is then chosen for the colormap's colours, and may end at clear
 * values. */
static void hold_clear_ends(const double all[2], const double range[2], bool mapped, double visible[2]) {
  const bool low = mapped || range[0] <= all[0], high = mapped || range[1] >= all[1];
  if (low && range[0] < visible[0]) visible[0] = fmax(range[0], all[0]);
  if (high && range[1] > visible[1]) visible[1] = fmin(range[1], all[1]);
}

/* Finds the widest run of clear points between visible ones, in a function that shows the least and the
 * greatest values. ends: the indices of the run's first and last points. Returns false if there is none. */
static bool find_gap(const hl_transfer_function *function, size_t ends[2]) {
  const hl_opacity_point *points = function->opacity;
  const size_t count = function->opacity_count;
  double widest = -1;
  if (count < 3 || points[0].opacity <= 0 || points[count - 1].opacity <= 0) return false;
  for (size_t n = 0; n < count; n++) {
    if (points[n].opacity > 0) continue;
    size_t last = n;
    while (points[last + 1].opacity <= 0) last++;
    const double wide = points[last].value - points[n].value;
    if (wide > widest) ends[0] = n, ends[1] = last, widest = wide;
    n = last;
  }
  return widest >= 0;
}

/* Keeps the clear values between visible ones where they are, as in the automatic function of a signed field:
 * they are its background, which would else be moved and become opaque. If the range lies on one side of
 * their middle, only this side of the function is kept. If it has both sides in it, the middle is returned,
 * as the value that keeps its place. Otherwise returns NAN. */
static double keep_background(const double range[2], hl_transfer_function *function) {
  size_t gap[2] = {0, 0};
  if (!find_gap(function, gap)) return NAN;
  const double middle = (function->opacity[gap[0]].value + function->opacity[gap[1]].value) / 2;
  if (range[0] >= middle) {
    function->opacity += gap[1];
    function->opacity_count -= gap[1];
  } else if (range[1] <= middle) {
    function->opacity_count = gap[0] + 1;
  } else {
    return middle;
  }
  return NAN;
}

hl_status hl_transfer_function_spread_over(hl_context *context, const hl_volume *volume,
                                           const hl_transfer_function *from, const double range[2],
                                           hl_range_scale scale, hl_spread_use use, hl_transfer_function *to,
                                           hl_error *error) {
  HL_DOOR;
  hl_volume_info info = {.struct_size = sizeof info};
  if (context == NULL || from == NULL || range == NULL || to == NULL ||
      hl_volume_get_info(volume, &info) != HL_OK)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_transfer_function_spread_over: null argument");
  double old[2], held[2];
  const bool projected = use == HL_SPREAD_PROJECTION;
  hl_transfer_function side = *from; /* borrows the points of *from */
  double hinge = projected ? NAN : keep_background(range, &side);
  hl_status status = graded_range(volume, &side, projected, old, error);
  if (status != HL_OK) return status;
  memcpy(held, old, sizeof held);
  if (!(old[0] < hinge && hinge < old[1])) hinge = NAN; /* the volume has values of one side alone */
  if (!projected && scale == HL_RANGE_LINEAR && info.range[0] < info.range[1])
    hold_clear_ends(info.range, range, use == HL_SPREAD_COLORMAP, held);
  return spread_checked(context, &side, old, held, hinge, range, scale, to, error);
}

hl_status hl_transfer_function_colormap_scaled(hl_context *context, const char *name, const double range[2],
                                               hl_range_scale scale, hl_transfer_function *function,
                                               hl_error *error) {
  HL_DOOR;
  hl_transfer_function even = {0}, scaled = {0};
  if (range == NULL || function == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_transfer_function_colormap_scaled: null range or function");
  hl_status status = hl_transfer_function_colormap(context, name, range[0], range[1], &even, error);
  if (status != HL_OK) return status;
  status = hl_transfer_function_spread(context, &even, range, range, scale, &scaled, error);
  hl_transfer_function_release(context, &even);
  if (status != HL_OK) return status;
  hl_release(context, (void *)function->color);
  function->color = scaled.color;
  function->color_count = scaled.color_count;
  return HL_OK;
}
