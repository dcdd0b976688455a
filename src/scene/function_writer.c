/* scene/function_writer.c - writes transfer functions in distances from a volume's background. */
#include "scene/function_writer.h"

#include <math.h>
#include <string.h>

#include "scene/colormap.h"
#include "scene/scene.h"

void hl_begin_function(hl_function_writer *w, const hl_data_analysis *analysis) {
  *w = (hl_function_writer){.analysis = analysis, .direction = analysis->direction};
}

void hl_add_opacity(hl_function_writer *w, double distance, double opacity) {
  if (w->opacity_count == sizeof w->opacity / sizeof *w->opacity) return;
  double value = w->analysis->background + w->direction * distance;
  w->opacity[w->opacity_count++] = (hl_opacity_point){value, fmin(fmax(opacity, 0), 1)};
}

void hl_add_color(hl_function_writer *w, double distance, const double color[3]) {
  if (w->color_count == sizeof w->color / sizeof *w->color) return;
  hl_color_point *point = &w->color[w->color_count++];
  point->value = w->analysis->background + w->direction * distance;
  memcpy(point->color, color, sizeof point->color);
}

void hl_add_colormap(hl_function_writer *w, const char *name, double from, double to, double start,
                     double end) {
  for (int step = 0; step <= 32; step++) {
    double t = step / 32.0, color[3];
    hl_colormap_evaluate(name, start + t * (end - start), color);
    hl_add_color(w, from + t * (to - from), color);
  }
}

double hl_opacity_for(const hl_data_analysis *analysis, double optical_depth) {
  return 1 - exp(-optical_depth / fmax(analysis->depth, 1));
}

/* Points were added with rising distance: where things are below the background, values fall. */
static void put_in_order(hl_function_writer *w) {
  if (w->direction > 0) return;
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

hl_status hl_finish_function(hl_function_writer *w, hl_context *context, const hl_volume *volume,
                             hl_transfer_function *function, hl_error *error) {
  put_in_order(w);
  double edge = mat3_shortest_column(volume->index_to_world.linear);
  hl_transfer_function made = {edge, w->opacity, w->opacity_count, w->color, w->color_count};
  return hl_transfer_function_copy(context, &made, function, error);
}
