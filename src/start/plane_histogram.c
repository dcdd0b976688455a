/* start/plane_histogram.c - counts voxels by value and gradient. The page's editor of transfer functions of
 * two numbers shows the counts under its boxes.
 *
 * Gradients are differences of neighbouring voxels per unit of length in the file. The grid's axes are
 * treated as perpendicular, even if they are not. In large volumes only every n-th voxel along each axis is
 * counted. */
#include "plane_histogram.h"
#include "elementary/elementary.h"

#include <math.h>
#include <stdlib.h>

enum { VALUES = 64, GRADIENTS = 48, FINE = 4096 };

/* The number of voxels that are counted, approximately. */
static const double SAMPLES = 200000;
/* The histogram ends at the gradient that this fraction of the voxels does not exceed. */
static const double WITHIN = 0.9995;

typedef struct sample {
  float value, gradient;
} sample;

/* The samples of a volume: every `step`-th voxel along each axis. */
typedef struct sampling {
  const hl_volume *volume;
  const hl_volume_info *info;
  size_t step;
  sample *samples; /* owned; [count] */
  size_t count;
} sampling;

static double gradient_at(const sampling *of, const size_t at[3]) {
  double sum = 0;
  for (int axis = 0; axis < 3; axis++) {
    size_t before[3] = {at[0], at[1], at[2]}, after[3] = {at[0], at[1], at[2]};
    if (before[axis] > 0) before[axis]--;
    if (after[axis] + 1 < of->info->dimensions[axis]) after[axis]++;
    if (after[axis] == before[axis]) continue;
    double rise = hl_volume_value(of->volume, after[0], after[1], after[2]) -
                  hl_volume_value(of->volume, before[0], before[1], before[2]);
    double slope = rise / ((double)(after[axis] - before[axis]) * of->info->spacing[axis]);
    sum += slope * slope;
  }
  return sqrt(sum);
}

static void take_samples(sampling *of) {
  const size_t *n = of->info->dimensions;
  size_t at[3];
  for (at[2] = 0; at[2] < n[2]; at[2] += of->step)
    for (at[1] = 0; at[1] < n[1]; at[1] += of->step)
      for (at[0] = 0; at[0] < n[0]; at[0] += of->step) {
        sample taken = {(float)hl_volume_value(of->volume, at[0], at[1], at[2]), (float)gradient_at(of, at)};
        if (isfinite(taken.value) && isfinite(taken.gradient)) of->samples[of->count++] = taken;
      }
}

static int bin_of(double x, double most, int bins) {
  int bin = most > 0 ? (int)(x / most * bins) : 0;
  return bin < 0 ? 0 : bin < bins ? bin : bins - 1;
}

/* The gradient that a fraction WITHIN of the sampled gradients does not exceed. */
static double greatest_drawn(const sampling *of) {
  size_t counts[FINE] = {0}, within = 0;
  double most = 0;
  for (size_t n = 0; n < of->count; n++) most = fmax(most, (double)of->samples[n].gradient);
  for (size_t n = 0; n < of->count; n++) counts[bin_of((double)of->samples[n].gradient, most, FINE)]++;
  for (int bin = 0; bin < FINE; bin++)
    if ((double)(within += counts[bin]) >= WITHIN * (double)of->count) return most * (bin + 1) / FINE;
  return most;
}

static void put_counts(FILE *out, const sampling *of) {
  unsigned counts[GRADIENTS][VALUES] = {{0}};
  const double *range = of->info->range, greatest = greatest_drawn(of);
  for (size_t n = 0; n < of->count; n++) {
    const sample *one = &of->samples[n];
    if ((double)one->gradient > greatest) continue;
    counts[bin_of((double)one->gradient, greatest, GRADIENTS)]
          [bin_of((double)one->value - range[0], range[1] - range[0], VALUES)]++;
  }
  fprintf(out, "{\"gradient\":%.9g,\"columns\":%d,\"rows\":%d,\"counts\":[", greatest > 0 ? greatest : 1.0,
          VALUES, GRADIENTS);
  for (int row = 0; row < GRADIENTS; row++)
    for (int column = 0; column < VALUES; column++)
      fprintf(out, "%s%u", row + column > 0 ? "," : "", counts[row][column]);
  fputs("]}", out);
}

void put_plane_histogram(FILE *out, const hl_volume *volume, const hl_volume_info *info) {
  const size_t *n = info->dimensions;
  double voxels = (double)n[0] * (double)n[1] * (double)n[2];
  sampling of = {volume, info, (size_t)ceil(hl_cbrt(fmax(voxels / SAMPLES, 1))), NULL, 0};
  size_t room = 1;
  for (int axis = 0; axis < 3; axis++) room *= (n[axis] + of.step - 1) / of.step;
  of.samples = malloc(room * sizeof *of.samples);
  if (of.samples == NULL) {
    fputs("null", out);
    return;
  }
  take_samples(&of);
  put_counts(out, &of);
  free(of.samples);
}
