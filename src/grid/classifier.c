/* grid/classifier.c - builds the tables of a transfer function. */
#include "grid/classifier.h"

#include <string.h>

#include "core/memory.h"
#include "core/sheet_constants.h"
#include "elementary/elementary.h"

/* The extinction sigma that belongs to an opacity alpha: sigma = -ln(1 - alpha) / u, where u is the length
 * for which the transfer function's opacities hold. alpha is clamped to 0.9999. */
static double extinction_of(const hl_transfer_function *function, double value) {
  double alpha = hl_transfer_function_opacity(function, value);
  if (alpha <= 0) return 0;
  if (alpha > 0.9999) alpha = 0.9999;
  return -hl_log1p(-alpha) / function->unit_distance;
}

double hl_transparent_below(const hl_volume *volume, const hl_transfer_function *function, double empty) {
  bool below_all = empty < volume->minimum && hl_transfer_function_opacity(function, empty) > 0;
  return below_all ? (empty + volume->minimum) / 2 : -INFINITY;
}

/* Fills the table of extinction's integrals. The integrals are exact, because extinction is linear between
 * entries. Over one step the mean extinction is (e0 + e1) / 2, where e0 and e1 are the extinctions at the
 * step's two ends. The extinction's moment about the step's start is (e0 + 2 e1) / 6 (derived). */
static void integrate(classifier *classifier) {
  double integral = 0, moment = 0;
  for (int entry = 0; entry <= CLASSIFIER_ENTRIES + 1; entry++) {
    classifier->sums[entry][1] = (float)integral;
    classifier->sums[entry][2] = (float)moment;
    if (entry > CLASSIFIER_ENTRIES) break;
    double e0 = classifier->sums[entry][0], e1 = classifier->sums[entry + 1][0];
    integral += (e0 + e1) / 2;
    moment += entry * (e0 + e1) / 2 + (e0 + 2 * e1) / 6;
  }
}

/* Fills the table of the integrals of extinction times colour, and of extinction alone. Over one step,
 * extinction changes linearly from e0 to e1, and the colour changes linearly from c0 to c1. The integral of
 * extinction times colour is then (e0 (2 c0 + c1) + e1 (c0 + 2 c1)) / 6 (derived). */
static void integrate_colors(classifier *classifier) {
  double integral[4] = {0, 0, 0, 0};
  for (int entry = 0; entry <= CLASSIFIER_ENTRIES + 1; entry++) {
    for (int i = 0; i < 4; i++) classifier->shown[entry][i] = (float)integral[i];
    if (entry > CLASSIFIER_ENTRIES) break;
    double e0 = classifier->sums[entry][0], e1 = classifier->sums[entry + 1][0];
    for (int c = 0; c < 3; c++) {
      double c0 = classifier->color[entry][c], c1 = classifier->color[entry + 1][c];
      integral[c] += (e0 * (2 * c0 + c1) + e1 * (c0 + 2 * c1)) / 6;
    }
    integral[3] += (e0 + e1) / 2;
  }
}

/* Fills the table of colours, and stores in classifier->bent the change of the colours' slope at each entry.
 */
static void fill_colors(const hl_transfer_function *function, double low, double high,
                        classifier *classifier) {
  double last[3][3]; /* the colours of the entries n, n - 1 and n - 2; the colour of entry n is stored at n %
                      * 3 */
  classifier->bent[0] = classifier->bent[CLASSIFIER_ENTRIES] = classifier->bent[CLASSIFIER_ENTRIES + 1] = 0;
  for (int entry = 0; entry <= CLASSIFIER_ENTRIES; entry++) {
    const double *second = last[(entry + 1) % 3], *before = last[(entry + 2) % 3];
    double *color = last[entry % 3], bend = 0;
    hl_transfer_function_color(function, low + (high - low) * entry / CLASSIFIER_ENTRIES, color);
    for (int c = 0; c < 3; c++) {
      classifier->color[entry][c] = (float)color[c];
      if (entry >= 2) bend = fmax(bend, fabs(color[c] - 2 * before[c] + second[c]));
    }
    if (entry >= 2) classifier->bent[entry - 1] = (float)bend;
  }
  memcpy(classifier->color[CLASSIFIER_ENTRIES + 1], classifier->color[CLASSIFIER_ENTRIES],
         sizeof classifier->color[0]);
}

/* Turns the changes of slope into sums from entry 0 on. Only entries that are visible or beside visible
 * entries count. If the changes are so small that no way through the table can have CLASSIFIER_LEAST_BENDING,
 * classifier->bent becomes null in place of the sums. */
static void sum_bends(classifier *classifier) {
  double sum = 0;
  for (int entry = 0; entry <= CLASSIFIER_ENTRIES + 1; entry++) {
    bool visible = classifier->sums[entry][0] > 0 || (entry > 0 && classifier->sums[entry - 1][0] > 0) ||
                   (entry <= CLASSIFIER_ENTRIES && classifier->sums[entry + 1][0] > 0);
    if (visible) sum += (double)classifier->bent[entry];
    classifier->bent[entry] = (float)sum;
  }
  if (sum * CLASSIFIER_ENTRIES <= CLASSIFIER_LEAST_BENDING) classifier->bent = NULL;
}

/* A second surface begins at a value where extinction rises by the factor SECOND_RISE after a level stretch
 * of values. On a level stretch, extinction does not rise. The stretch takes at least the fraction LEVEL_PART
 * of the values from the beginning of the first surface on. */
static const double SECOND_RISE = 1.5, LEVEL_PART = 0.05;

/* Finds where surfaces begin, for the values on one side of the empty value. The function looks at the
 * table's entries one by one, from entry `first` on, away from the empty value. step: 1 or -1, the direction
 * of the next entry. */
static void fill_side(classifier *classifier, int first, int step) {
  const float(*sums)[4] = (const float(*)[4])classifier->sums;
  float foot = classifier->offset, level = 0;
  int mark = -1, end = step > 0 ? CLASSIFIER_ENTRIES + 2 : -1;
  for (int at = first; at != end; at += step) {
    float extinction = sums[at][0];
    double back = at - step * fmax(ceil(LEVEL_PART * fabs((double)at - (double)foot)), 1);
    if (!(extinction > 0)) {
      foot = (float)at;
      mark = -1;
    } else if ((back - (double)foot) * step > 0 && extinction <= sums[(int)back][0] &&
               (mark < 0 || extinction <= level)) {
      mark = at;
      level = extinction;
    } else if (mark >= 0 && (double)extinction >= SECOND_RISE * (double)level) {
      foot = (float)mark;
      for (int of = mark; of != at; of += step) classifier->outside[step > 0 ? of : of - 1] = foot;
      mark = -1;
    }
    if (step > 0 || at > 0) classifier->outside[step > 0 ? at : at - 1] = foot;
  }
}

/* Fills the table of surfaces. A value above the empty value lies in matter whose outside has lower values; a
 * value below the empty value lies in matter whose outside has higher values. */
static void fill_outside(classifier *classifier) {
  const int empty = (int)ceilf(classifier->offset);
  fill_side(classifier, empty, 1);
  if (classifier->offset > 0) {
    classifier->outside[empty - 1] = classifier->offset;
    fill_side(classifier, (int)floorf(classifier->offset), -1);
  }
}

/* The integral of extinction over table entries from 0 to x. x is a coordinate of the tables, which counts
 * entries. */
static float integral_to(const classifier *classifier, float x) {
  const float *at = classifier->sums[(int)x], *next = classifier->sums[(int)x + 1];
  return at[1] + (next[1] - at[1]) * (x - (float)(int)x);
}

/* Finds, for each surface, the integral of extinction up to the coordinate where the surface begins
 * (integral_to()), and whether there are several surfaces. */
static void fill_beginnings(classifier *classifier) {
  float only = 0, only_side = 0;
  int surfaces = 0;
  for (int entry = 0; entry <= CLASSIFIER_ENTRIES; entry++) {
    float foot = classifier->outside[entry], side = (float)entry >= foot ? 1 : -1;
    classifier->sums[entry][3] = integral_to(classifier, foot);
    if (!(classifier->sums[entry][0] > 0) && !(classifier->sums[entry + 1][0] > 0)) continue;
    if (surfaces > 0 && foot == only && side == only_side) continue;
    only = foot;
    only_side = side;
    classifier->only_beginning = classifier->sums[entry][3];
    surfaces++;
  }
  classifier->several_surfaces = surfaces > 1;
}

static void fill_tables(const hl_scene_volume *volume, double empty, double low, double high,
                        classifier *classifier) {
  const hl_transfer_function *function = &volume->transfer_function;
  double nothing = hl_transparent_below(volume->volume, &volume->transfer_function, empty);
  for (int entry = 0; entry <= CLASSIFIER_ENTRIES; entry++) {
    double value = low + (high - low) * entry / CLASSIFIER_ENTRIES;
    if (value < nothing) classifier->sums[entry][0] = 0;
    else if (classifier->plane.sums == NULL)
      classifier->sums[entry][0] = (float)extinction_of(function, value);
  }
  classifier->sums[CLASSIFIER_ENTRIES + 1][0] = classifier->sums[CLASSIFIER_ENTRIES][0];
  fill_colors(function, low, high, classifier);
  integrate(classifier);
  integrate_colors(classifier);
  sum_bends(classifier);
  int32_t next = CLASSIFIER_ENTRIES + 2;
  for (int entry = CLASSIFIER_ENTRIES + 1; entry >= 0; entry--) {
    if (classifier->sums[entry][0] > 0) next = entry;
    classifier->next_visible[entry] = next;
  }
  int last = CLASSIFIER_ENTRIES;
  while (last > 0 && !(classifier->sums[last][0] > 0)) last--;
  classifier->first_visible = (float)classifier->next_visible[0] - 1;
  classifier->last_visible = (float)last + 1;
  fill_outside(classifier);
  fill_beginnings(classifier);
}

/* The least gradient of values that counts as a surface: a thousandth of the transfer function's span of
 * values, per voxel edge. */
static float normal_edge(const hl_scene_volume *volume, double entries_per_value) {
  const hl_transfer_function *function = &volume->transfer_function;
  double span = function->opacity_count == 0
                    ? 0
                    : function->opacity[function->opacity_count - 1].value - function->opacity[0].value;
  if (!(span > 0)) span = 1;
  /* the map's rotation is left out, because it does not change lengths */
  mat3 placed = volume->volume->index_to_world.linear;
  for (int axis = 0; axis < 3; axis++)
    placed.row[axis] = vec3_scale(placed.row[axis], volume->axis_scale[axis]);
  double edge = mat3_shortest_column(placed) * volume->scale;
  return (float)fmin(fmax(1e-3 * span / edge * entries_per_value, 1e-30), 1e30);
}

/* The narrowest range of values that tables cover, as a multiple of value_scale. A float could not hold the
 * scale of a narrower range. So a narrower range is widened, and the range's values then share one entry. */
static const double NARROWEST_RANGE = 1e-34;

void hl_classifier_lay_out(const hl_transfer_function *function, classifier *classifier, hl_layout *layout) {
  enum { COUNT = CLASSIFIER_ENTRIES + 2 };
  classifier->sums = hl_layout_take(layout, COUNT, sizeof *classifier->sums);
  classifier->color = hl_layout_take(layout, COUNT, sizeof *classifier->color);
  classifier->shown = hl_layout_take(layout, COUNT, sizeof *classifier->shown);
  classifier->bent = hl_layout_take(layout, COUNT, sizeof *classifier->bent);
  classifier->next_visible = hl_layout_take(layout, COUNT, sizeof *classifier->next_visible);
  classifier->outside = hl_layout_take(layout, COUNT, sizeof *classifier->outside);
  if (function->gradient_opacity_count > 0)
    classifier->steepness = hl_layout_take(layout, STEEPNESS_ENTRIES + 2, sizeof *classifier->steepness);
  hl_plane_table_lay_out(function, &classifier->plane, layout);
}

/* Fills the factors of gradient opacity. The table covers gradients from 0 to the gradient of the last point.
 * If all factors are 1, the table is left out. */
static void fill_steepness(const hl_transfer_function *function, double value_scale, classifier *classifier) {
  size_t count = function->gradient_opacity_count;
  if (count == 0) return;
  double last = function->gradient_opacity[count - 1].value;
  if (!(last > 0)) last = 1;
  for (int entry = 0; entry <= STEEPNESS_ENTRIES; entry++)
    classifier->steepness[entry] = (float)hl_transfer_function_gradient_opacity(
        function, last * entry / STEEPNESS_ENTRIES);
  classifier->steepness[STEEPNESS_ENTRIES + 1] = classifier->steepness[STEEPNESS_ENTRIES];
  classifier->steepness_scale = (float)fmin(fabs(value_scale) / last * STEEPNESS_ENTRIES, 1e30);
  int entry = 0;
  while (entry <= STEEPNESS_ENTRIES && classifier->steepness[entry] == 1.0f) entry++;
  if (entry > STEEPNESS_ENTRIES) classifier->steepness = NULL;
}

hl_status hl_classifier_create(hl_context *context, const hl_scene_volume *volume,
                               const hl_scene_volume *second, const grid *grid, classifier *classifier,
                               hl_error *error) {
  const hl_transfer_function *function = &volume->transfer_function;
  *classifier = (struct classifier){0};
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, context)) hl_classifier_lay_out(function, classifier, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "a transfer-function table");
  memset(layout.base, 0, layout.bytes);
  double empty = grid->empty * grid->value_scale + grid->value_offset;
  double low = fmin(volume->volume->minimum, empty), high = fmax(volume->volume->maximum, empty);
  /* the range is widened by a part of |low|, because adding 1 to 1e30 changes nothing */
  if (!(high > low)) high = low + fmax(1, 1e-12 * fabs(low));
  high = fmax(high, low + NARROWEST_RANGE * fabs(grid->value_scale));
  classifier->scale = (float)(grid->value_scale * CLASSIFIER_ENTRIES / (high - low));
  classifier->offset = (float)((empty - low) * CLASSIFIER_ENTRIES / (high - low));
  classifier->normal_edge = normal_edge(volume, CLASSIFIER_ENTRIES / (high - low));
  if (classifier->plane.sums != NULL)
    hl_plane_table_fill(
        volume, second, grid,
        &(plane_values){low, high, hl_transparent_below(volume->volume, &volume->transfer_function, empty)},
        CLASSIFIER_ENTRIES, &classifier->plane, classifier->sums);
  fill_tables(volume, empty, low, high, classifier);
  fill_steepness(function, grid->value_scale, classifier);
  return HL_OK;
}

void hl_classifier_release(hl_context *context, classifier *classifier) {
  hl_release(context, classifier->sums);
  *classifier = (struct classifier){0};
}

bool hl_classifier_span_visible(const classifier *classifier, const grid *grid, float low, float high) {
  float a = (low - grid->empty) * classifier->scale + classifier->offset;
  float b = (high - grid->empty) * classifier->scale + classifier->offset;
  float least = fminf(a, b), greatest = fmaxf(a, b);
  /* if the caller has changed a voxel to NaN, a bound may be NaN; a NaN counts as an end of the tables' range
   */
  int32_t first = !(least > 0) ? 0 : least >= CLASSIFIER_ENTRIES ? CLASSIFIER_ENTRIES : (int32_t)least;
  int32_t last = !(greatest > 0)                  ? 1
                 : greatest >= CLASSIFIER_ENTRIES ? CLASSIFIER_ENTRIES + 1
                                                  : (int32_t)greatest + 1;
  return classifier->next_visible[first] <= last;
}

bool hl_classifier_range_visible(const classifier *classifier, const grid *grid, float low, float high) {
  return hl_classifier_span_visible(classifier, grid, fminf(low, grid->empty), fmaxf(high, grid->empty));
}
