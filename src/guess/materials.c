/* guess/materials.c - finds the materials of scanned objects: peaks of the histogram with valleys between
 * them. */
#include <stdbool.h>

#include "guess/analysis.h"

/* Two neighbouring peaks count as two if the valley between them is lower than this fraction of the lower
 * peak. */
static const double DEEPEST = 0.35;
/* The least fraction of the objects' voxels that a material's peak has. */
static const double LEAST_SHARE = 0.03;

enum {
  BINS = HL_HISTOGRAM_BINS,
  REACH = 4 /* REACH: the number of bins to each side over which counts are smoothed */
};

/* Counts the objects' voxels in bins of rising distance. A tent smooths the counts, so that the gaps of
 * quantised data close. Returns the number of bins. *first: the distance of the first bin. */
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
  for (int n = 0; n < count; n++) {
    double sum = 0, weights = 0;
    for (int m = n - REACH; m <= n + REACH; m++) {
      if (m < 0 || m >= count) continue;
      double weight = REACH + 1 - (m > n ? m - n : n - m);
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

void hl_data_find_materials(const hl_volume *volume, hl_data_analysis *a) {
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
