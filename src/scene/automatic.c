/* scene/automatic.c - from an analysis of the data to a transfer function that shows it.
 *
 * Opacities are per smallest voxel edge. Surfaces become solid within the ramp between where things begin and
 * where they surely are; fields and media get an optical depth across the whole object, so that large and
 * small grids look alike.
 */
#include "scene/automatic.h"

#include <math.h>

#include "core/error.h"
#include "scene/function_writer.h"

#define MEDIUM_DEPTH 5.0 /* optical depth of smoke across its own size */

static void write_surfaces(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  double ramp = a->solid - a->faint, dense = fmax(a->dense, a->solid + 1e-6 * a->top),
         top = fmax(a->top, dense * 1.001);
  hl_add_opacity(w, a->faint, 0);
  hl_add_opacity(w, a->faint + 0.35 * ramp, 0.08);
  hl_add_opacity(w, a->faint + 0.7 * ramp, 0.28);
  hl_add_opacity(w, a->solid, 0.5);
  hl_add_opacity(w, a->solid + 0.5 * (dense - a->solid), 0.75);
  hl_add_opacity(w, dense, 0.95);
  static const double outer[3] = {0.40, 0.18, 0.10}, skin[3] = {0.70, 0.40, 0.26},
                      inner[3] = {0.88, 0.70, 0.48}, densest[3] = {0.95, 0.93, 0.88};
  hl_add_color(w, a->faint, outer);
  hl_add_color(w, a->solid, skin);
  hl_add_color(w, dense, inner);
  hl_add_color(w, top, densest);
}

static void write_field(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  double ramp = a->solid - a->faint, top = fmax(a->top, a->solid * 1.001);
  hl_add_opacity(w, a->faint, 0);
  hl_add_opacity(w, a->faint + 0.15 * ramp, hl_opacity_for(a, 0.8));
  hl_add_opacity(w, a->faint + 0.7 * ramp, hl_opacity_for(a, 1.2));
  hl_add_opacity(w, a->solid, hl_opacity_for(a, 2.5));
  hl_add_opacity(w, a->solid + 0.25 * (top - a->solid), hl_opacity_for(a, 15));
  hl_add_opacity(w, top, hl_opacity_for(a, 80));
  static const double shell[3] = {0.04, 0.20, 0.55}, flesh[3] = {0.16, 0.50, 0.72},
                      pale[3] = {0.94, 0.68, 0.30}, core[3] = {0.88, 0.24, 0.06};
  hl_add_color(w, a->faint, shell);
  hl_add_color(w, a->solid, flesh);
  hl_add_color(w, a->solid + 0.25 * (top - a->solid), pale);
  hl_add_color(w, top, core);
}

void hl_write_medium(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  static const double white[3] = {0.8, 0.8, 0.8};
  for (int step = 0; step <= 32; step++) {
    double distance = a->top * step / 32;
    hl_add_opacity(w, distance, hl_opacity_for(a, MEDIUM_DEPTH * distance / a->mean));
  }
  hl_add_color(w, 0, white);
}

static void write_signed(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  static const double cold[3][3] = {{0.10, 0.30, 0.75}, {0.06, 0.18, 0.62}, {0.02, 0.06, 0.35}};
  static const double warm[3][3] = {{0.95, 0.52, 0.20}, {0.85, 0.28, 0.08}, {0.60, 0.08, 0.03}};
  w->direction = 1; /* both sides are written at once */
  double ramp = a->solid - a->faint, top = fmax(a->top, a->solid * 1.001);
  double at[5] = {a->faint, a->faint + 0.5 * ramp, a->solid, a->solid + 0.5 * (top - a->solid), top};
  double opacity[5] = {0, hl_opacity_for(a, 2), hl_opacity_for(a, 15), hl_opacity_for(a, 60),
                       hl_opacity_for(a, 100)};
  for (int p = 4; p >= 0; p--) hl_add_opacity(w, -at[p], opacity[p]);
  for (int p = 0; p < 5; p++) hl_add_opacity(w, at[p], opacity[p]);
  for (int p = 2; p >= 0; p--) hl_add_color(w, -at[2 * p], cold[p]);
  for (int p = 0; p < 3; p++) hl_add_color(w, at[2 * p], warm[p]);
}

static void write_constant(hl_function_writer *w) {
  static const double grey[3] = {0.6, 0.6, 0.6};
  hl_add_opacity(w, 0, 0.2);
  hl_add_color(w, 0, grey);
}

void hl_write_for_kind(hl_function_writer *w) {
  switch (w->analysis->kind) {
    case HL_DATA_SURFACES: write_surfaces(w); break;
    case HL_DATA_FIELD: write_field(w); break;
    case HL_DATA_SIGNED: write_signed(w); break;
    case HL_DATA_MEDIUM: hl_write_medium(w); break;
    case HL_DATA_CONSTANT: write_constant(w); break;
  }
}

hl_status hl_transfer_function_from_analysis(hl_context *context, const hl_volume *volume,
                                             const hl_data_analysis *analysis, hl_transfer_function *function,
                                             hl_error *error) {
  hl_function_writer w;
  hl_begin_function(&w, analysis);
  hl_write_for_kind(&w);
  return hl_finish_function(&w, context, volume, function, error);
}

hl_status hl_transfer_function_automatic(hl_context *context, const hl_volume *volume,
                                         hl_transfer_function *function, hl_error *error) {
  if (context == NULL || volume == NULL || function == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_transfer_function_automatic: null context, volume or function");
  hl_data_analysis analysis;
  hl_status status = hl_data_analyse(volume, &analysis, error);
  if (status != HL_OK) return status;
  return hl_transfer_function_from_analysis(context, volume, &analysis, function, error);
}
