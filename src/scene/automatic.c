/* scene/automatic.c - from an analysis of the data to a transfer function that shows it.
 *
 * Opacities are per smallest voxel edge. Surfaces become solid within the ramp between where things begin and where
 * they surely are; fields and media get an optical depth across the whole object, so that large and small grids
 * look alike.
 */
#include "scene/automatic.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "scene/colormap.h"
#include "scene/scene.h"

#define MEDIUM_DEPTH 5.0 /* optical depth of smoke across its own size */

/* A transfer function being written, in distances from the background. */
typedef struct writer {
  const hl_data_analysis *analysis;
  hl_opacity_point opacity[80];
  hl_color_point color[200];
  size_t opacity_count, color_count;
} writer;

static void add_opacity(writer *w, double distance, double opacity) {
  double value = w->analysis->background + w->analysis->direction * distance;
  w->opacity[w->opacity_count++] = (hl_opacity_point){value, fmin(fmax(opacity, 0), 1)};
}

static void add_color(writer *w, double distance, const double color[3]) {
  hl_color_point *point = &w->color[w->color_count++];
  point->value = w->analysis->background + w->analysis->direction * distance;
  memcpy(point->color, color, sizeof point->color);
}

/* Points were added with rising distance: where things are below the background, values fall. */
static void put_in_order(writer *w) {
  if (w->analysis->direction > 0) return;
  for (size_t a = 0, b = w->opacity_count; a + 1 < b; a++) {
    hl_opacity_point swap = w->opacity[--b];
    w->opacity[b] = w->opacity[a];
    w->opacity[a] = swap;
  }
  for (size_t a = 0, b = w->color_count; a + 1 < b; a++) {
    hl_color_point swap = w->color[--b];
    w->color[b] = w->color[a];
    w->color[a] = swap;
  }
}

/* The opacity per voxel edge that gives an optical depth across the object. */
static double opacity_for(const hl_data_analysis *a, double optical_depth) {
  return 1 - exp(-optical_depth / fmax(a->depth, 1));
}

static void add_colormap(writer *w, const char *name, double from, double to, double start, double end) {
  for (int step = 0; step <= 32; step++) {
    double t = step / 32.0, color[3];
    hl_colormap_evaluate(name, start + t * (end - start), color);
    add_color(w, from + t * (to - from), color);
  }
}

static void write_surfaces(writer *w) {
  const hl_data_analysis *a = w->analysis;
  double ramp = a->solid - a->faint, dense = fmax(a->dense, a->solid + 1e-6 * a->top), top = fmax(a->top, dense * 1.001);
  add_opacity(w, a->faint, 0);
  add_opacity(w, a->faint + 0.4 * ramp, 0.06);
  add_opacity(w, a->solid, 0.5);
  add_opacity(w, a->solid + 0.5 * ramp, 0.85);
  add_opacity(w, a->solid + 1.5 * ramp, 0.95);
  static const double outer[3] = {0.50, 0.24, 0.13}, skin[3] = {0.72, 0.42, 0.26}, inner[3] = {0.86, 0.72, 0.52},
                      densest[3] = {0.93, 0.90, 0.82};
  add_color(w, a->faint, outer);
  add_color(w, a->solid, skin);
  add_color(w, dense, inner);
  add_color(w, top, densest);
}

static void write_field(writer *w) {
  const hl_data_analysis *a = w->analysis;
  double ramp = a->solid - a->faint, top = fmax(a->top, a->solid * 1.001);
  add_opacity(w, a->faint, 0);
  add_opacity(w, a->faint + 0.3 * ramp, opacity_for(a, 0.8));
  add_opacity(w, a->faint + 0.8 * ramp, opacity_for(a, 2));
  add_opacity(w, a->solid + 0.25 * (top - a->solid), opacity_for(a, 20));
  add_opacity(w, top, opacity_for(a, 60));
  add_colormap(w, "viridis", a->faint, top, 0.25, 1);
}

static void write_medium(writer *w) {
  const hl_data_analysis *a = w->analysis;
  static const double white[3] = {0.9, 0.9, 0.9};
  for (int step = 0; step <= 32; step++) {
    double distance = a->top * step / 32;
    add_opacity(w, distance, opacity_for(a, MEDIUM_DEPTH * distance / a->mean));
  }
  add_color(w, 0, white);
}

static void write_signed(writer *w) {
  const hl_data_analysis *a = w->analysis;
  static const double cold[3][3] = {{0.10, 0.30, 0.75}, {0.06, 0.18, 0.62}, {0.02, 0.06, 0.35}};
  static const double warm[3][3] = {{0.95, 0.52, 0.20}, {0.85, 0.28, 0.08}, {0.60, 0.08, 0.03}};
  double ramp = a->solid - a->faint, top = fmax(a->top, a->solid * 1.001);
  double at[5] = {a->faint, a->faint + 0.5 * ramp, a->solid, a->solid + 0.5 * (top - a->solid), top};
  double opacity[5] = {0, opacity_for(a, 2), opacity_for(a, 15), opacity_for(a, 60), opacity_for(a, 100)};
  for (int p = 4; p >= 0; p--) add_opacity(w, -at[p], opacity[p]);
  for (int p = 0; p < 5; p++) add_opacity(w, at[p], opacity[p]);
  for (int p = 2; p >= 0; p--) add_color(w, -at[2 * p], cold[p]);
  for (int p = 0; p < 3; p++) add_color(w, at[2 * p], warm[p]);
}

static void write_constant(writer *w) {
  static const double grey[3] = {0.6, 0.6, 0.6};
  add_opacity(w, 0, 0.2);
  add_color(w, 0, grey);
}

hl_status hl_transfer_function_from_analysis(hl_context *context, const hl_volume *volume,
                                             const hl_data_analysis *analysis, hl_transfer_function *function,
                                             hl_error *error) {
  writer w = {.analysis = analysis};
  hl_data_analysis upright;
  if (analysis->kind == HL_DATA_SIGNED) { /* both sides are written at once */
    upright = *analysis;
    upright.direction = 1;
    w.analysis = &upright;
  }
  switch (analysis->kind) {
    case HL_DATA_SURFACES: write_surfaces(&w); break;
    case HL_DATA_FIELD: write_field(&w); break;
    case HL_DATA_SIGNED: write_signed(&w); break;
    case HL_DATA_MEDIUM: write_medium(&w); break;
    case HL_DATA_CONSTANT: write_constant(&w); break;
  }
  put_in_order(&w);
  double edge = INFINITY;
  for (int a = 0; a < 3; a++) edge = fmin(edge, vec3_length(mat3_column(volume->index_to_world.linear, a)));
  hl_transfer_function made = {edge, w.opacity, w.opacity_count, w.color, w.color_count};
  return hl_transfer_function_copy(context, &made, function, error);
}

hl_status hl_transfer_function_automatic(hl_context *context, const hl_volume *volume, hl_transfer_function *function,
                                         hl_error *error) {
  if (context == NULL || volume == NULL || function == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_transfer_function_automatic: null context, volume or function");
  hl_data_analysis analysis;
  hl_status status = hl_data_analyse(volume, &analysis, error);
  if (status != HL_OK) return status;
  return hl_transfer_function_from_analysis(context, volume, &analysis, function, error);
}
