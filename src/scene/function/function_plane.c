/* scene/function/function_plane.c - the boxes, polygons, images and curves of a transfer function of two
 * numbers: evaluates their opacity and colour at a point of the plane of the two numbers, or their mean over
 * a part of the plane.
 *
 * In: a transfer function. Out: extinction and colour, for the tables of grid/plane_table.c, for the
 * reference, and for the outline: a function of the value alone, which framing and exposure use. */
#include "scene/function/function_plane.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/vector.h"
#include "elementary/elementary.h"
#include "scene/function/points.h"

/* ---- weights ---- */

/* The integral, along one axis, of the weight of a box with soft edges, from the box's low end to x. */
static double weight_up_to(double low, double high, double edge, double x) {
  if (x <= low) return 0;
  if (x >= high) return high - low - edge;
  if (x < low + edge) return (x - low) * (x - low) / (2 * edge);
  if (x > high - edge) return high - low - edge - (high - x) * (high - x) / (2 * edge);
  return x - low - edge / 2;
}

/* The integral of a Gaussian's weight along an axis, from its middle to x. */
static double gaussian_up_to(double middle, double deviation, double x) {
  return deviation * sqrt(HL_PI / 2) * hl_erf((x - middle) / (deviation * sqrt(2)));
}

/* The mean of a box's Gaussian along one axis, over the part from `from` to `to`. */
static double gaussian_along(const hl_function_box *box, int axis, double from, double to) {
  double low = box->low[axis], high = box->high[axis], middle = (low + high) / 2,
         deviation = box->sigma * (high - low), begin = fmax(from, low), end = fmin(to, high);
  if (begin > end || !(deviation > 0)) return 0;
  if (!(to > from)) return hl_exp(-(from - middle) * (from - middle) / (2 * deviation * deviation));
  return (gaussian_up_to(middle, deviation, end) - gaussian_up_to(middle, deviation, begin)) / (to - from);
}

/* The mean weight of a box along one axis, over the part from `from` to `to`. The whole weight of the box is
 * the product of the weights along both axes. */
static double weight_along(const hl_function_box *box, int axis, double from, double to) {
  if (box->sigma > 0) return gaussian_along(box, axis, from, to);
  double low = box->low[axis], high = box->high[axis], edge = fmin(box->edge[axis], (high - low) / 2);
  if (to > from && high > low)
    return (weight_up_to(low, high, edge, to) - weight_up_to(low, high, edge, from)) / (to - from);
  if (from < low || from > high) return 0;
  return edge > 0 ? fmin(fmin(from - low, high - from) / edge, 1) : 1;
}

/* The weight of a point in the triangle of the apex and two vertices: the apex's barycentric coordinate,
 * which falls linearly from 1 at the apex to 0 on the border. The weight is negative if the point is outside
 * the triangle. */
static double weight_in_triangle(const double apex[2], const double a[2], const double b[2],
                                 const double at[2]) {
  double ax = a[0] - apex[0], ay = a[1] - apex[1], bx = b[0] - apex[0], by = b[1] - apex[1];
  double x = at[0] - apex[0], y = at[1] - apex[1], area = ax * by - ay * bx;
  if (area == 0) return -1;
  double of_a = (x * by - y * bx) / area, of_b = (ax * y - ay * x) / area;
  return of_a < 0 || of_b < 0 ? -1 : 1 - of_a - of_b;
}

static double weight_in_polygon(const hl_function_polygon *polygon, const double at[2]) {
  double greatest = -1;
  for (size_t v = 0; v < polygon->vertex_count; v++) {
    size_t next = v + 1 < polygon->vertex_count ? v + 1 : 0;
    greatest = fmax(greatest,
                    weight_in_triangle(polygon->apex, polygon->vertices[v], polygon->vertices[next], at));
  }
  if (greatest < 0) return 0;
  return polygon->falloff > 0 ? fmin(greatest / polygon->falloff, 1) : 1;
}

/* ---- sums ---- */

static double extinction_of(double opacity, double unit) { return -hl_log1p(-fmin(opacity, 0.9999)) / unit; }

static void add(plane_sum *sum, double extinction, const double color[3]) {
  sum->extinction += extinction;
  for (int c = 0; c < 3; c++) sum->color[c] += extinction * color[c];
}

static void add_boxes(const hl_transfer_function *function, const plane_box *part, plane_sum *sum) {
  for (size_t b = 0; b < function->plane.box_count; b++) {
    const hl_function_box *box = &function->plane.boxes[b];
    double weight = weight_along(box, 0, part->low[0], part->high[0]);
    if (weight > 0) weight *= weight_along(box, 1, part->low[1], part->high[1]);
    if (weight > 0) add(sum, weight * extinction_of(box->opacity, function->unit_distance), box->color);
  }
}

static void add_polygons(const hl_transfer_function *function, const double at[2], double share,
                         plane_sum *sum) {
  for (size_t p = 0; p < function->plane.polygon_count; p++) {
    const hl_function_polygon *polygon = &function->plane.polygons[p];
    double weight = share * weight_in_polygon(polygon, at);
    if (weight > 0)
      add(sum, weight * extinction_of(polygon->opacity, function->unit_distance), polygon->color);
  }
}

/* Finds the colour and opacity of the image at a point of the plane, interpolated bilinearly between
 * pixels. */
static void sample_image(const hl_function_image *image, const double at[2], double pixel[4]) {
  const int size[2] = {image->width, image->height};
  int first[2], next[2];
  double part[2];
  for (int a = 0; a < 2; a++) {
    double t = (at[a] - image->low[a]) / (image->high[a] - image->low[a]);
    double x = fmin(fmax((a == 0 ? t : 1 - t) * size[a] - 0.5, 0), size[a] - 1);
    first[a] = (int)x;
    next[a] = first[a] + 1 < size[a] ? first[a] + 1 : first[a];
    part[a] = x - first[a];
  }
  for (int c = 0; c < 4; c++) {
    double row[2];
    for (int y = 0; y < 2; y++) {
      const float *of_row = image->pixels + 4 * (size_t)(y ? next[1] : first[1]) * (size_t)image->width + c;
      double a = (double)of_row[4 * (size_t)first[0]], b = (double)of_row[4 * (size_t)next[0]];
      row[y] = a + part[0] * (b - a);
    }
    pixel[c] = row[0] + part[1] * (row[1] - row[0]);
  }
}

static void add_image(const hl_transfer_function *function, const double at[2], double share,
                      plane_sum *sum) {
  const hl_function_image *image = &function->plane.image;
  double pixel[4];
  if (image->pixels == NULL) return;
  for (int a = 0; a < 2; a++)
    if (!(at[a] >= image->low[a] && at[a] <= image->high[a])) return;
  sample_image(image, at, pixel);
  if (!(pixel[3] > 0)) return;
  const double color[3] = {pixel[0] / pixel[3], pixel[1] / pixel[3], pixel[2] / pixel[3]};
  add(sum, share * extinction_of(pixel[3], function->unit_distance), color);
}

void hl_curves_color(const hl_function_curves *curves, double second, const double own[3], double color[3]) {
  if (hl_curves_keep_own(curves, second)) memcpy(color, own, 3 * sizeof *color);
  else hl_points_color(curves->color, curves->color_count, second, color);
}

/* Adds the curves' mean extinction over the values of a part of the plane, in their mean colour over the
 * part. */
static void add_curves(const hl_transfer_function *function, const plane_box *part, int samples,
                       plane_sum *sum) {
  const hl_function_curves *curves = &function->plane.curves;
  double extinction = 0, color[3] = {0, 0, 0};
  if (curves->opacity_count == 0 || isnan(part->low[0])) return;
  for (int n = 0; n < samples; n++) {
    const double along = (n + 0.5) / samples;
    double at[2], own[3], one[3];
    for (int axis = 0; axis < 2; axis++)
      at[axis] = part->low[axis] + (part->high[axis] - part->low[axis]) * along;
    const double opacity = hl_points_opacity(curves->opacity, curves->opacity_count, at[0]);
    extinction += extinction_of(opacity, function->unit_distance) / samples;
    hl_points_color(curves->own_color, curves->own_color_count, at[0], own);
    hl_curves_color(curves, at[1], own, one);
    for (int c = 0; c < 3; c++) color[c] += one[c] / samples;
  }
  add(sum, extinction, color);
}

enum { SAMPLES = 3 /* number of samples along each side of a part of the plane */ };

plane_sum hl_plane_mean(const hl_transfer_function *function, const plane_box *part) {
  plane_sum sum = {0, {0, 0, 0}};
  const hl_function_plane *plane = &function->plane;
  bool is_point = part->low[0] == part->high[0] && part->low[1] == part->high[1];
  int samples = is_point ? 1 : SAMPLES;
  add_boxes(function, part, &sum);
  add_curves(function, part, samples, &sum);
  if (plane->polygon_count == 0 && plane->image.pixels == NULL) return sum;
  for (int j = 0; j < samples; j++)
    for (int i = 0; i < samples; i++) {
      const double at[2] = {part->low[0] + (part->high[0] - part->low[0]) * (i + 0.5) / samples,
                            part->low[1] + (part->high[1] - part->low[1]) * (j + 0.5) / samples};
      add_polygons(function, at, 1.0 / (samples * samples), &sum);
      add_image(function, at, 1.0 / (samples * samples), &sum);
    }
  return sum;
}

/* ---- the box around all shapes ---- */

static void join(plane_box *bounds, const double low[2], const double high[2]) {
  for (int a = 0; a < 2; a++) {
    bounds->low[a] = fmin(bounds->low[a], low[a]);
    bounds->high[a] = fmax(bounds->high[a], high[a]);
  }
}

/* Extends a box of the plane of two numbers by the curves of opacity and colour: along the values, to those
 * at which the curves may be visible, and along the second numbers, to those between which the colour
 * changes.
 */
static void join_curves(const hl_function_curves *curves, plane_box *bounds) {
  const hl_opacity_point *points = curves->opacity;
  size_t first = 0, end = curves->opacity_count, colors = curves->color_count;
  while (first < end && !(points[first].opacity > 0)) first++;
  if (first == end) return;
  while (!(points[end - 1].opacity > 0)) end--;
  const double low[2] = {first > 0 ? points[first - 1].value : -INFINITY,
                         colors > 0 ? curves->color[0].value : 0};
  const double high[2] = {end < curves->opacity_count ? points[end].value : INFINITY,
                          colors > 0 ? curves->color[colors - 1].value : 0};
  join(bounds, low, high);
  for (int side = 0; side < 2 && hl_curves_have_own(curves); side++) {
    const double border = curves->own_between[side];
    if (fabs(border) < HL_CURVES_NO_END)
      join(bounds, (double[2]){low[0], border}, (double[2]){high[0], border});
  }
}

bool hl_plane_bounds(const hl_function_plane *plane, plane_box *bounds) {
  *bounds = (plane_box){{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
  for (size_t b = 0; b < plane->box_count; b++) join(bounds, plane->boxes[b].low, plane->boxes[b].high);
  for (size_t p = 0; p < plane->polygon_count; p++)
    for (size_t v = 0; v < plane->polygons[p].vertex_count; v++)
      join(bounds, plane->polygons[p].vertices[v], plane->polygons[p].vertices[v]);
  if (plane->image.pixels != NULL) join(bounds, plane->image.low, plane->image.high);
  if (plane->curves.opacity_count > 0) join_curves(&plane->curves, bounds);
  return bounds->low[0] <= bounds->high[0];
}

/* ---- the outline over the value alone ---- */

enum { OUTLINE_COLUMNS = 257 };

/* A column of the outline, for one value: the greatest opacity of a shape in the column, the sum of all
 * shapes' opacities, and the sum of colour times opacity. */
typedef struct column {
  double greatest, opacity, color[3];
} column;

static void note(column *column, double opacity, const double color[3]) {
  column->greatest = fmax(column->greatest, opacity);
  column->opacity += opacity;
  for (int c = 0; c < 3; c++) column->color[c] += opacity * color[c];
}

static void note_image(const hl_function_image *image, double from, double to, column *column) {
  if (image->pixels == NULL || to < image->low[0] || from > image->high[0]) return;
  double pixel = (image->high[0] - image->low[0]) / image->width;
  int first = (int)fmax(floor((from - image->low[0]) / pixel - 0.5), 0),
      last = (int)fmin(ceil((to - image->low[0]) / pixel - 0.5), image->width - 1);
  for (int y = 0; y < image->height; y++)
    for (int x = first; x <= last; x++) {
      const float *at = image->pixels + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
      double opacity = (double)at[3];
      if (!(opacity > 0)) continue;
      const double color[3] = {(double)at[0] / opacity, (double)at[1] / opacity, (double)at[2] / opacity};
      note(column, opacity, color);
    }
}

/* Notes the greatest opacity of the curves from `from` to `to`, in the volume's own colour, or in the mean of
 * all colours of the second number. */
static void note_curves(const hl_function_curves *curves, double from, double to, column *column) {
  double greatest = 0, color[3] = {1, 1, 1};
  if (curves->opacity_count == 0) return;
  for (size_t n = 0; n < curves->opacity_count; n++)
    if (curves->opacity[n].value > from && curves->opacity[n].value < to)
      greatest = fmax(greatest, curves->opacity[n].opacity);
  for (int end = 0; end < 2; end++)
    greatest = fmax(greatest, hl_points_opacity(curves->opacity, curves->opacity_count, end ? to : from));
  for (size_t n = 0; n < curves->color_count; n++)
    for (int c = 0; c < 3; c++) color[c] += ((double)curves->color[n].color[c] - color[c]) / (double)(n + 1);
  if (hl_curves_have_own(curves))
    hl_points_color(curves->own_color, curves->own_color_count, (from + to) / 2, color);
  if (greatest > 0) note(column, greatest, color);
}

static column column_between(const hl_function_plane *plane, double from, double to) {
  column found = {0, 0, {0, 0, 0}};
  for (size_t b = 0; b < plane->box_count; b++) {
    const hl_function_box *box = &plane->boxes[b];
    double middle = fmin(fmax((box->low[0] + box->high[0]) / 2, from), to);
    double weight = weight_along(box, 0, middle, middle);
    if (weight > 0) note(&found, 1 - hl_pow(1 - box->opacity, weight), box->color);
  }
  for (size_t p = 0; p < plane->polygon_count; p++) {
    const hl_function_polygon *polygon = &plane->polygons[p];
    double low = INFINITY, high = -INFINITY;
    for (size_t v = 0; v < polygon->vertex_count; v++) {
      low = fmin(low, polygon->vertices[v][0]);
      high = fmax(high, polygon->vertices[v][0]);
    }
    if (to >= low && from <= high) note(&found, polygon->opacity, polygon->color);
  }
  note_image(&plane->image, from, to, &found);
  note_curves(&plane->curves, from, to, &found);
  return found;
}

/* Replaces a function of two numbers by its outline. If shapes go on beyond the values `low` or `high`, the
 * outline keeps its opacity beyond these values; otherwise the outline's opacity falls to 0. */
hl_status hl_plane_outline(hl_context *context, double low, double high, hl_transfer_function *function,
                           hl_error *error) {
  plane_box bounds;
  hl_opacity_point *opacity = hl_allocate(context, OUTLINE_COLUMNS + 2, sizeof *opacity);
  hl_color_point *color = hl_allocate(context, OUTLINE_COLUMNS, sizeof *color);
  function->opacity = opacity;
  function->color = color;
  function->opacity_count = function->color_count = 0;
  if (opacity == NULL || color == NULL)
    return hl_fail_memory(error, OUTLINE_COLUMNS * sizeof *color, "a transfer function");
  bool some = hl_plane_bounds(&function->plane, &bounds) && bounds.low[0] <= high && bounds.high[0] >= low;
  double from = fmax(bounds.low[0], low), to = fmin(bounds.high[0], high);
  size_t points = 0, columns = !some ? 0 : to > from ? OUTLINE_COLUMNS : 1;
  if (!some) opacity[points++] = (hl_opacity_point){low, 0};
  if (some && bounds.low[0] > low) opacity[points++] = (hl_opacity_point){nextafter(from, -INFINITY), 0};
  for (size_t n = 0; n < columns; n++) {
    double step = (to - from) / (OUTLINE_COLUMNS - 1),
           value = n + 1 == columns ? to : from + step * (double)n;
    column found = column_between(&function->plane, value - step, value + step);
    opacity[points++] = (hl_opacity_point){value, fmin(found.greatest, 1)};
    if (!(found.opacity > 0)) continue;
    hl_color_point *point = &color[function->color_count++];
    point->value = value;
    for (int c = 0; c < 3; c++) point->color[c] = fmin(found.color[c] / found.opacity, 1);
  }
  if (some && bounds.high[0] < high) opacity[points++] = (hl_opacity_point){nextafter(to, INFINITY), 0};
  function->opacity_count = points;
  return HL_OK;
}
