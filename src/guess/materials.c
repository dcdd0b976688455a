/* guess/materials.c - finds the materials of scanned objects: peaks of the histogram with valleys between
 * them.
 *
 * A voxel at the boundary of two kinds of matter has a value between the values of the two. Flat faces along
 * the grid's axes give many such voxels the same value, so that the histogram has a peak that is no material.
 * A voxel at a boundary lies between a lighter and a denser neighbour. */
#include <stdbool.h>
#include <string.h>

#include "guess/analysis.h"
#include "volume/store/glimpse.h"

/* Two neighbouring peaks count as two if the valley between them is lower than this fraction of the lower
 * peak. */
static const double DEEPEST = 0.35;
/* The least fraction of the objects' voxels that a material's peak has. */
static const double LEAST_SHARE = 0.03;

/* A peak is no material if more than this fraction of its voxels lies between a lighter and a denser
 * neighbour. Voxels of a material lie so only where the material is one or two voxels thin. In four scans,
 * the fraction is at most .24 for materials; for the two boundaries of a casting, it is .54 and .94
 * (measured). */
static const double MOST_BETWEEN = 0.4;

enum {
  BINS = HL_HISTOGRAM_BINS,
  TENT = 5 /* the least distance, in bins, from the middle of the tent that smooths counts to its ends */
};

/* The distance, in bins, between neighbouring values of quantised data: at least half of the voxels have a
 * value from which the next higher value of the data is at most this distance away. */
static int value_step(const double *raw, int count) {
  double voxels[BINS] = {0}, all = 0; /* voxels: [distance to the next higher value] */
  for (int n = 0, last = -1; n < count; n++) {
    if (!(raw[n] > 0)) continue;
    if (last >= 0) voxels[n - last] += raw[last], all += raw[last];
    last = n;
  }
  int step = 1;
  for (double sum = voxels[1]; 2 * sum < all; sum += voxels[step]) step++;
  return step;
}

/* Counts the objects' voxels in bins of rising distance. A tent smooths the counts. The distance from the
 * tent's middle to its ends is a multiple of the distance between quantised values, so that the tent closes
 * the gaps between these values exactly. Returns the number of bins. *first: the distance of the first bin.
 */
static int object_bins(const hl_volume *volume, const hl_data_analysis *a, double counts[BINS],
                       double *first) {
  double width = (volume->maximum - volume->minimum) / BINS, raw[BINS];
  int count = 0;
  for (int n = 0; n < BINS; n++) {
    int bin = a->direction > 0 ? n : BINS - 1 - n;
    double distance = a->direction * (volume->minimum + (bin + 0.5) * width - a->background);
    if (distance <= a->faint || distance > a->top) continue; /* the last bins may hold saturated values */
    if (count == 0) *first = distance;
    raw[count++] = (double)volume->histogram[bin];
  }
  const int step = value_step(raw, count), tent = (TENT + step - 1) / step * step;
  for (int n = 0; n < count; n++) {
    double sum = 0, weights = 0;
    for (int m = n - tent + 1; m < n + tent; m++) {
      if (m < 0 || m >= count) continue;
      double weight = tent - (m > n ? m - n : n - m);
      sum += weight * raw[m];
      weights += weight;
    }
    counts[n] = sum / weights;
  }
  return count;
}

/* Finds where the peak at bin `from` ends: in the valley before the next peak, or after the last bin. */
static int end_of_peak(const double *counts, int count, int from) {
  double peak = counts[from], valley = counts[from];
  int at_valley = from;
  for (int n = from; n < count; n++) {
    if (counts[n] < valley) valley = counts[n], at_valley = n;
    if (valley < DEEPEST * peak && counts[n] > valley / DEEPEST) return at_valley; /* the next peak begins */
    if (counts[n] > peak) peak = valley = counts[n], at_valley = n;
  }
  return count;
}

/* Finds the first bin after the tail of the background's peak. A peak that is highest in the first bin
 * belongs to the background, and not to a material. */
static int end_of_tail(const double *counts, int count) {
  int end = end_of_peak(counts, count, 0);
  bool falls = true;
  for (int n = 0; n < end; n++) falls = falls && counts[n] <= counts[0];
  return falls && end < count ? end : 0;
}

/* Finds the peaks, and divides them at the valleys between them. */
static void find_peaks(const hl_volume *volume, hl_data_analysis *a) {
  double counts[BINS], first = 0, all = 0, pending = 0;
  double width = (volume->maximum - volume->minimum) / BINS;
  int count = object_bins(volume, a, counts, &first);
  for (int n = 0; n < count; n++) all += counts[n];
  a->material_count = count > 0 ? 1 : 0;
  for (int from = end_of_tail(counts, count), end; from < count; from = end) {
    end = end_of_peak(counts, count, from);
    for (int n = from; n < end; n++) pending += counts[n];
    if (end == count || a->material_count == HL_MOST_MATERIALS) break;
    if (pending < LEAST_SHARE * all)
      continue; /* the peak has too few voxels for a material, and is added to the next one */
    double rest = 0;
    for (int n = end; n < count; n++) rest += counts[n];
    if (rest < LEAST_SHARE * all) break;
    a->valleys[a->material_count++ - 1] = first + (end - 0.5) * width;
    pending = 0;
  }
}

/* ---- peaks that are no materials ---- */

/* The number of the peak to which a voxel's value belongs; -1 for the background. */
static int peak_of(const hl_data_analysis *a, double value) {
  const double distance = a->direction * (value - a->background);
  if (!(distance > a->faint)) return -1;
  int peak = 0;
  while (peak + 1 < a->material_count && distance > a->valleys[peak]) peak++;
  return peak;
}

/* Returns whether a voxel lies between a neighbour of a lower peak and a neighbour of a higher peak, which
 * are on opposite sides of the voxel. */
static bool lies_between(const hl_volume *volume, const hl_data_analysis *a, const size_t at[3], int peak) {
  for (int axis = 0; axis < 3; axis++) {
    size_t before[3] = {at[0], at[1], at[2]}, behind[3] = {at[0], at[1], at[2]};
    before[axis]--;
    behind[axis]++;
    const int one = peak_of(a, hl_volume_value_within(volume, before[0], before[1], before[2])),
              other = peak_of(a, hl_volume_value_within(volume, behind[0], behind[1], behind[2]));
    if ((one < peak && other > peak) || (one > peak && other < peak)) return true;
  }
  return false;
}

/* Joins the peaks that are no materials with the next denser peak. */
static void join_boundaries(const hl_volume *volume, hl_data_analysis *a) {
  const size_t *n = volume->dimension, step = hl_lattice_step(n, HL_LATTICE_PLACES);
  size_t between[HL_MOST_MATERIALS] = {0}, all[HL_MOST_MATERIALS] = {0};
  for (size_t k = 1; k + 1 < n[2]; k += step)
    for (size_t j = 1; j + 1 < n[1]; j += step)
      for (size_t i = 1; i + 1 < n[0]; i += step) {
        const int peak = peak_of(a, hl_volume_value_within(volume, i, j, k));
        if (peak < 0) continue;
        all[peak]++;
        between[peak] += lies_between(volume, a, (size_t[3]){i, j, k}, peak);
      }
  for (int peak = a->material_count - 2; peak >= 0; peak--) {
    if (!((double)between[peak] > MOST_BETWEEN * (double)all[peak])) continue;
    memmove(&a->valleys[peak], &a->valleys[peak + 1],
            (size_t)(a->material_count - 2 - peak) * sizeof *a->valleys);
    a->material_count--;
  }
}

void hl_data_find_materials(const hl_volume *volume, hl_data_analysis *a) {
  find_peaks(volume, a);
  if (a->material_count > 1) join_boundaries(volume, a);
}
