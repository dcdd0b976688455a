/* scene/seen.c - the values of a volume that a transfer function lets be seen, from any side.
 *
 * In: voxels and opacities. Out: two values between which nearly all lies that is seen. What opaque matter
 * surrounds is hidden from every side, and a surface is seen by the voxels at its rim: a voxel counts with
 * its opacity and with the light that its most transparent neighbour lets through, in and out again.
 */
#include "core/error.h"
#include "scene/sample.h"
#include "scene/scene.h"

#define PLACES 5e5  /* looked at, about */
#define TAIL   0.01 /* part of what is seen that lies beyond either end */

enum { BINS = 4096 };

/* The least opacity per voxel edge of the six neighbours; that of a neighbour outside the grid is 0. */
static double least_opacity_around(const hl_volume *volume, const hl_transfer_function *function,
                                   const size_t at[3]) {
  double least = 1;
  for (int n = 0; n < 6; n++) {
    size_t next[3] = {at[0], at[1], at[2]};
    next[n / 2] += n % 2 == 0 ? 1 : (size_t)-1; /* below 0: outside, as beyond the end */
    least = fmin(least,
                 hl_transfer_function_opacity(function, hl_volume_value(volume, next[0], next[1], next[2])));
  }
  return least;
}

/* Counts what is seen in equal bins over [low, high]. */
static double count_seen(const hl_volume *volume, const hl_transfer_function *function, double low,
                         double high, double *counts) {
  const size_t *n = volume->dimension;
  size_t step = hl_lattice_step(n, PLACES), at[3];
  double sum = 0;
  for (at[2] = 0; at[2] < n[2]; at[2] += step)
    for (at[1] = 0; at[1] < n[1]; at[1] += step)
      for (at[0] = 0; at[0] < n[0]; at[0] += step) {
        double value = hl_volume_value(volume, at[0], at[1], at[2]),
               opacity = hl_transfer_function_opacity(function, value);
        if (!(opacity > 0) || !(value >= low && value <= high)) continue;
        double light = 1 - least_opacity_around(volume, function, at), seen = opacity * light * light;
        int bin = (int)((value - low) / (high - low) * BINS);
        counts[bin < BINS ? bin : BINS - 1] += seen;
        sum += seen;
      }
  return sum;
}

/* The value that the part `fraction` of the counts lies below. */
static double quantile(const double *counts, double sum, double fraction, double low, double high) {
  double below = 0;
  int bin = 0;
  while (bin + 1 < BINS && below + counts[bin] < fraction * sum) below += counts[bin++];
  double within = counts[bin] > 0 ? (fraction * sum - below) / counts[bin] : 0.5;
  return low + (high - low) * (bin + fmin(fmax(within, 0), 1)) / BINS;
}

hl_status hl_transfer_function_seen_range(const hl_volume *volume, const hl_transfer_function *function,
                                          double range[2], hl_error *error) {
  if (volume == NULL || function == NULL || range == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_transfer_function_seen_range: null volume, function or range");
  double counts[BINS] = {0}, low = volume->minimum, high = volume->maximum;
  range[0] = low;
  range[1] = high > low ? high : low + 1;
  double sum = high > low ? count_seen(volume, function, low, high, counts) : 0;
  if (!(sum > 0)) return HL_OK;
  double first = quantile(counts, sum, TAIL, low, high), last = quantile(counts, sum, 1 - TAIL, low, high);
  if (last - first <
      100 * (high - low) / BINS) { /* outliers took nearly all bins: once more between the ends */
    double bin = (high - low) / BINS, near[BINS] = {0};
    low = fmax(low, first - bin), high = fmin(high, last + bin);
    sum = count_seen(volume, function, low, high, near);
    first = quantile(near, sum, TAIL, low, high), last = quantile(near, sum, 1 - TAIL, low, high);
  }
  if (last > first) range[0] = first, range[1] = last;
  return HL_OK;
}
