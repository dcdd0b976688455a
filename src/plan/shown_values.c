/* plan/shown_values.c - see shown_values.h. The ends of the shown ranges are found by bisection. */
#include "plan/shown_values.h"

#include <float.h>
#include <math.h>

#include "scene/scene.h"

/* The table coordinate of a value comes from rounded sums of floats. So the ends of the shown ranges are
 * moved by ROUNDINGS times the rounding error of the greatest voxel, and at least by LEAST_END entries. Then
 * a value at the end of a range is shown exactly where the transfer function shows it. */
static const double LEAST_END = 1e-3, ROUNDINGS = 8;

enum { BISECTIONS = 30 };

/* The input of the search: a volume's transfer function, and the map from coordinates of the classifier's
 * tables to data values. */
typedef struct shown_values {
  const hl_transfer_function *function; /* the volume's transfer function; borrowed */
  double low, step; /* low: the data value of the coordinate 0; step: the difference between the data values
                     * of neighbouring coordinates */
  double nothing;   /* the data value below which matter does not exist */
  double end;       /* the distance, in entries of the table, by which the ends of ranges are moved */
} shown_values;

static bool shows(const shown_values *values, double from, double to) {
  double low = fmax(values->low + from * values->step, values->nothing),
         high = values->low + to * values->step;
  return low <= high && hl_transfer_function_visible(values->function, low, high);
}

/* Finds the greatest value (if `greatest` is set) or the least value that is shown between an entry and the
 * next one, as a coordinate of the table. */
static double end_of_step(const shown_values *values, int entry, bool greatest) {
  double inside = entry, outside = entry + 1;
  /* if the greatest value is searched for: something is shown between `inside` and entry + 1 */
  for (int i = 0; i < BISECTIONS; i++) {
    double middle = (inside + outside) / 2;
    bool some = greatest ? shows(values, middle, entry + 1) : shows(values, entry, middle);
    if (some == greatest) inside = middle;
    else outside = middle;
  }
  return (inside + outside) / 2;
}

/* Returns whether opacity rises from 0 without a jump at `from`, so that the value at this end is itself not
 * shown. */
static bool rises_from(const shown_values *values, double from) {
  double near = values->low + (from + values->end) * values->step,
         far = values->low + (from + 2 * values->end) * values->step;
  return hl_transfer_function_opacity(values->function, near) <
         0.75 * hl_transfer_function_opacity(values->function, far);
}

static void fill_step(const shown_values *values, int entry, double below, float row[4]) {
  bool any = shows(values, entry, entry + 1);
  double from = 2 * CLASSIFIER_ENTRIES, to = below;
  if (any) {
    from = shows(values, entry, entry) ? entry : end_of_step(values, entry, false);
    to = shows(values, entry + 1, entry + 1) ? entry + 1 : end_of_step(values, entry, true);
    from += rises_from(values, from) ? values->end : -values->end;
  }
  row[SHOWN_FROM] = (float)from;
  row[SHOWN_TO] = (float)to;
  row[SHOWN_BELOW] = (float)below;
  row[3] = 0;
}

static double end_of(const frame_volume *of, double step) {
  const hl_volume *volume = of->volume;
  double greatest = fmax(fmax(fabs(volume->minimum), fabs(volume->maximum)), fabs(of->empty));
  return fmax(LEAST_END, ROUNDINGS * FLT_EPSILON * greatest / step);
}

void hl_shown_values_fill(const hl_transfer_function *function, const frame_volume *volume, const grid *grid,
                          float (*rows)[4]) {
  const classifier *classifier = volume->classifier;
  double empty = volume->empty, step = grid->value_scale / (double)classifier->scale;
  const shown_values values = {function, empty - (double)classifier->offset * step, step,
                               hl_transparent_below(volume->volume, function, empty),
                               end_of(volume, fabs(step))};
  double below = -1;
  for (int entry = 0; entry < SHOWN_ENTRIES; entry++) {
    fill_step(&values, entry < CLASSIFIER_ENTRIES ? entry : CLASSIFIER_ENTRIES, below, rows[entry]);
    if (rows[entry][SHOWN_FROM] <= entry + 1) below = (double)rows[entry][SHOWN_TO];
  }
}
